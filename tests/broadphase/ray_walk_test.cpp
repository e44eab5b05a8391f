// SPDX-License-Identifier: Zlib

// Rays that walk through the cells of a table. That they miss nothing, see box_tree_test.cpp.

#include <broadphase/search/ray_walk.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::boxesIn;
using test::cubesIn;
using test::drawBoxes;
using test::Random;

template <class Scalar>
class RayWalkTest : public testing::Test {
protected:
    using Ray = RayRegion<Scalar>;
    using Slots = std::vector<std::uint32_t>;

    Slots walk(const Ray& ray) {
        Slots slots;
        cost_ = {};
        const auto take = [&](std::span<const std::uint32_t> some) {
            slots.insert(slots.end(), some.begin(), some.end());
            return 1.0;
        };
        EXPECT_TRUE(searchCells(table_, ray, 1.0, take, cost_));
        return slots;
    }
    void expectLikeBruteForce(const Ray& ray) {
        Slots offered = walk(ray);
        std::sort(offered.begin(), offered.end());
        ASSERT_EQ(std::adjacent_find(offered.begin(), offered.end()), offered.end());
        for (std::uint32_t slot = 0; slot < boxes_.size(); ++slot) {
            // Bullet's test hits inverted boxes, too, as if they were the right way round.
            const Aabb<Scalar> box(boxes_[slot].min().cwiseMin(boxes_[slot].max()),
                                   boxes_[slot].min().cwiseMax(boxes_[slot].max()));
            ASSERT_TRUE(ray.key(box) < 0 ||
                        std::binary_search(offered.begin(), offered.end(), slot))
                << slot;
        }
    }
    void expectLikeBruteForce(int count, double low, double high) {
        for (int i = 0; i < count; ++i) {
            const Vector3<Scalar> from = random_.pointIn(low, high).template cast<Scalar>();
            expectLikeBruteForce({from, random_.pointIn(low, high).template cast<Scalar>()});
            Vector3<Scalar> beside = from;
            beside[i % 3] += static_cast<Scalar>(i % 2 == 0 ? 9 : -9);
            expectLikeBruteForce({from, beside});
        }
    }

    Random random_{0x5eed0b01};
    std::vector<Aabb<Scalar>> boxes_;
    Table<Scalar> table_;
    QueryCost cost_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RayWalkTest, Scalars);

TYPED_TEST(RayWalkTest, ReadsACrowdOfBoxesOnlyAlongItsWay) {
    this->boxes_ =
        drawBoxes<TypeParam>(this->random_, 30'000, boxesIn<TypeParam>(-30, 30, 0.25, 0.75));
    test::fill(this->table_, this->boxes_);
    this->expectLikeBruteForce(100, -30, 30);
    for (int axis = 0; axis < 3; ++axis) {
        Vector3<TypeParam> to(1, 2, 3);
        to[axis] += 3;
        this->walk({{1, 2, 3}, to});
        EXPECT_LT(this->cost_.boxesTested, 300U);
        to[axis] += 50;
        this->walk({{1, 2, 3}, to});
        EXPECT_LT(this->cost_.boxesTested, 2000U);
    }
}

TYPED_TEST(RayWalkTest, IsExactWhereBoxesAreOfAllSizesFarApartOrFlat) {
    this->boxes_ = drawBoxes<TypeParam>(this->random_, 1000, cubesIn<TypeParam>(-5, 5, 0.1));
    for (const auto& more :
         {drawBoxes<TypeParam>(this->random_, 500, boxesIn<TypeParam>(-5, 5, 0, 4)),
          drawBoxes<TypeParam>(this->random_, 500, cubesIn<TypeParam>(900, 1000, 0.5)),
          drawBoxes<TypeParam>(this->random_, 500, cubesIn<TypeParam>(-4000, 4000, 0.5))}) {
        this->boxes_.insert(this->boxes_.end(), more.begin(), more.end());
    }
    test::fill(this->table_, this->boxes_);
    this->expectLikeBruteForce(200, -5, 5);
    this->expectLikeBruteForce(200, 890, 1010);
    this->expectLikeBruteForce(100, -4000, 4000);
    for (Aabb<TypeParam>& box : this->boxes_) {
        box.min()[1] = 0;
        box.max()[1] = 1;
    }
    test::fill(this->table_, this->boxes_);
    this->expectLikeBruteForce(200, -5, 5);
}

// Along one axis, or two, few boxes are near a ray. Among them are inverted ones, which reach back from where they
// begin, and rays are as thick as a box, or end where one begins.
TYPED_TEST(RayWalkTest, PassesByOnlyWhatItMissesWherePilesAreFarApart) {
    for (int flat = 0; flat < 3; ++flat) {
        for (const std::size_t pileSize : {20U, 60U, 400U}) {
            this->boxes_.clear();
            for (int pile = 0; pile < 20; ++pile) {
                Vector3<double> corner = this->random_.pointIn(-5000, 5000);
                corner[flat] = 0;
                for (const Aabb<TypeParam>& box : drawBoxes<TypeParam>(
                         this->random_, pileSize, boxesIn<TypeParam>(0, 6, 0.25, 0.75))) {
                    this->boxes_.push_back(box);
                    this->boxes_.back().translate(corner.cast<TypeParam>());
                }
            }
            for (std::size_t i = 0; i < this->boxes_.size(); i += 10) {
                const auto axis = static_cast<Eigen::Index>(i / 10 % 3);
                std::swap(this->boxes_[i].min()[axis], this->boxes_[i].max()[axis]);
            }
            test::fill(this->table_, this->boxes_);
            for (std::size_t i = 0; i < 100; ++i) {
                const Aabb<TypeParam>& target = this->boxes_[7 * i % this->boxes_.size()];
                const Vector3<TypeParam> to = i % 2 == 0 ? target.min() : target.center();
                const Vector3<TypeParam> off =
                    this->random_.pointIn(-100, 100).template cast<TypeParam>();
                this->expectLikeBruteForce({to + off, to});
                const auto half = Vector3<TypeParam>::Constant(static_cast<TypeParam>(i % 3));
                this->expectLikeBruteForce({to, to + off, {-half, half}});
                Vector3<TypeParam> along = to;
                along[static_cast<Eigen::Index>(i % 3)] += off[0];
                this->expectLikeBruteForce({along, to});
            }
        }
    }
}

TYPED_TEST(RayWalkTest, ReadsARowInOnePartWhereFewBoxesAre) {
    for (int i = 0; i < 1000; ++i) {
        this->boxes_.push_back(boxAround<TypeParam>({8.0 * i, 0, 0}, {0.5, 0.5, 0.5}));
    }
    test::fill(this->table_, this->boxes_);
    EXPECT_EQ(this->walk({{-3, 0, 0}, {197, 0, 0}}).size(), 25U);
    EXPECT_LE(this->cost_.rowsVisited, 4U);
    EXPECT_LE(this->cost_.boxesTested, 100U);
    EXPECT_EQ(this->walk({{-3, 0, 0}, {7900, 0, 0}}).size(), 988U);
}

// Many share a cell, of which some are inverted: what is sorted along an axis must not hide them.
TYPED_TEST(RayWalkTest, FindsInvertedBoxesInACrowdedCell) {
    this->boxes_ = drawBoxes<TypeParam>(this->random_, 2000, cubesIn<TypeParam>(-50, 50, 0.01));
    for (std::size_t i = 0; i < this->boxes_.size(); i += 20) {
        Aabb<TypeParam>& box = this->boxes_[i];
        box.max()[static_cast<Eigen::Index>(i / 20 % 3)] -= 20;
    }
    LevelSizes sizes;
    sizes.count = 1;
    sizes.cellSize[0] = 50;
    test::fill(this->table_, this->boxes_, sizes);
    this->expectLikeBruteForce(300, -50, 50);
}

TYPED_TEST(RayWalkTest, LeavesOutWhatWasErased) {
    this->boxes_ = drawBoxes<TypeParam>(this->random_, 500, cubesIn<TypeParam>(-5, 5, 1));
    test::fill(this->table_, this->boxes_);
    for (std::uint32_t entry = 0; entry < 500; ++entry) {
        this->table_.erase(entry);
    }
    EXPECT_TRUE(this->walk({{-9, -9, -9}, {9, 9, 9}}).empty());
}

TYPED_TEST(RayWalkTest, GoesFromNearToFarAsFarAsTheLimit) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            std::vector<Aabb<TypeParam>> boxes;
            for (int i = 0; i < 2000; ++i) {
                Vector3<double> center(0, 0, 0);
                center[axis] = sign * (i + 0.5);
                boxes.push_back(boxAround<TypeParam>(center, {0.25, 0.25, 0.25}));
            }
            // So many beside the way that to read them all would cost more.
            for (int i = 0; i < 50'000; ++i) {
                Vector3<double> center = this->random_.pointIn(3, 1000);
                center[axis] = sign * (i % 2000 + 0.5);
                boxes.push_back(boxAround<TypeParam>(center, {0.25, 0.25, 0.25}));
            }
            test::fill(this->table_, boxes);
            Vector3<TypeParam> to(0, 0, 0);
            to[axis] = static_cast<TypeParam>(sign * 2000);
            std::vector<std::uint32_t> offered;
            QueryCost cost;
            const auto take = [&](std::span<const std::uint32_t> some) {
                offered.insert(offered.end(), some.begin(), some.end());
                return 0.1;
            };
            EXPECT_TRUE(
                searchCells(this->table_, RayRegion<TypeParam>({0, 0, 0}, to), 1.0, take, cost));
            EXPECT_TRUE(std::is_sorted(offered.begin(), offered.end()));
            EXPECT_GE(offered.size(), 200U);
            EXPECT_LT(offered.size(), 202U);
            EXPECT_LT(cost.boxesTested, 1000U);
        }
    }
}

TYPED_TEST(RayWalkTest, EndsWhenToldTo) {
    this->boxes_ = drawBoxes<TypeParam>(this->random_, 500, cubesIn<TypeParam>(-5, 5, 1));
    test::fill(this->table_, this->boxes_);
    const RayRegion<TypeParam> ray({-9, -9, -9}, {9, 9, 9});
    for (const double end : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        int calls = 0;
        const auto take = [&](std::span<const std::uint32_t> /*some*/) {
            ++calls;
            return end;
        };
        EXPECT_FALSE(searchCells(this->table_, ray, 1.0, take, this->cost_));
        EXPECT_EQ(calls, 1);
        EXPECT_FALSE(searchCells(this->table_, ray, end, take, this->cost_));
        EXPECT_EQ(calls, 1);
    }
}

}  // namespace
}  // namespace hashphase::detail
