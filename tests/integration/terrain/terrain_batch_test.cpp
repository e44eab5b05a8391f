// SPDX-License-Identifier: Zlib

// Many points and spheres at once: the same as one by one, in any number, on any threads, at a cost
// that is told.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainBatch : public testing::Test {
protected:
    using Found = std::optional<Ground<Scalar>>;

    void draw(std::size_t count) {
        points_.clear();
        radii_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            points_.push_back(random_.pointIn({-2, 0, -2}, {42, 5, 42}).template cast<Scalar>());
            radii_.push_back(static_cast<Scalar>(random_.between(0, 1.5)));
            if (random_.chance(0.01)) {
                points_.back()[random_.below(3)] = std::numeric_limits<Scalar>::quiet_NaN();
            }
            if (random_.chance(0.01)) {
                radii_.back() = -1;
            }
        }
        found_.resize(count);
    }

    /// As the answers of one by one, which asks for point i and adds up its cost.
    template <class OneByOne>
    void expectAs(const OneByOne& oneByOne, const QueryCost& cost) {
        QueryCost sum;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            ASSERT_EQ(found_[i], oneByOne(i, &sum));
        }
        EXPECT_EQ(cost.hits, sum.hits);
        EXPECT_LE(cost.rowsVisited, sum.rowsVisited);  // near ones share them
    }
    void expectAsOneByOne(ParallelFor parallelFor) {
        const Terrain<Scalar>& terrain = world_.terrain;
        QueryCost cost = terrain.surfacesBelow(points_, found_, parallelFor);
        expectAs(
            [&](std::size_t i, QueryCost* sum) { return terrain.surfaceBelow(points_[i], sum); },
            cost);
        cost = terrain.restingHeights(points_, radii_, found_, parallelFor);
        expectAs([&](std::size_t i,
                     QueryCost* sum) { return terrain.restingHeight(points_[i], radii_[i], sum); },
                 cost);
    }

    Random random_{0x5eed2301};
    GroundWorld<Scalar> world_{roughGround<Scalar>(random_, 40, 1, 3, 0.15)};
    std::vector<Vector3<Scalar>> points_;
    std::vector<Scalar> radii_;
    std::vector<Found> found_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainBatch, Scalars);

TYPED_TEST(TerrainBatch, IsAsOneByOne) {
    for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 1023U, 1024U, 9999U, 140000U}) {
        SCOPED_TRACE(count);
        this->draw(count);
        this->expectAsOneByOne(serialFor);
    }
}

// More than the places in an order, all in a single tile.
TYPED_TEST(TerrainBatch, IsAsOneByOneAtASingleSpot) {
    for (const std::size_t count : {65535U, 65536U, 65540U}) {
        SCOPED_TRACE(count);
        this->draw(count);
        for (Vector3<TypeParam>& point : this->points_) {
            point = at<TypeParam>(20.25, point.y(), 20.25);
        }
        this->expectAsOneByOne(serialFor);
    }
}

TYPED_TEST(TerrainBatch, IsTheSameOnAnyThreads) {
    this->draw(50000);
    for (const std::size_t threads : {2U, 5U}) {
        ThreadedFor threadedFor(threads, threads);
        this->expectAsOneByOne(threadedFor);
        EXPECT_GT(threadedFor.mostRanges(), 2U);
    }
}

TYPED_TEST(TerrainBatch, SeesChangesThatWaitToBeFiled) {
    this->draw(2000);
    const std::vector<Vector3<TypeParam>> corners{{0, 4, 0}, {40, 4, 0}, {0, 4, 40}};
    const std::uint32_t number = this->world_.terrain.add(corners).first;
    this->expectAsOneByOne(serialFor);
    const std::vector<Vector3<TypeParam>> high{at<TypeParam>(5, 9, 5)};
    std::vector<std::optional<Ground<TypeParam>>> found(1);
    this->world_.terrain.surfacesBelow(high, found);
    EXPECT_EQ(found[0], (Ground<TypeParam>{number, 4}));
}

TYPED_TEST(TerrainBatch, CostsWhatTheColumnsMeetAndNoMoreAfterAShiftOfTheOrigin) {
    this->draw(10000);
    const auto ask = [this] {
        const QueryCost cost = this->world_.terrain.surfacesBelow(this->points_, this->found_);
        EXPECT_GT(cost.hits, 10000U);
        EXPECT_LT(cost.hits, 80000U);
        EXPECT_LT(cost.boxesTested, 1000000U);  // of 3,200 triangles a hundred each, at most
        return cost.rowsVisited;
    };
    const std::uint64_t before = ask();
    const Vector3<TypeParam> shift(1024, 0, -4096);
    this->world_.grid.shiftOrigin(shift);
    this->world_.terrain.shiftOrigin(shift);
    for (Vector3<TypeParam>& point : this->points_) {
        point -= shift;
    }
    EXPECT_LE(ask(), before + before / 50);
}

TYPED_TEST(TerrainBatch, HasAPlaceForEachAnswer) {
    if (!HASHPHASE_ENABLE_ASSERTS) {
        return;
    }
    const ThrowingAsserts asserts;
    this->draw(10);
    this->found_.resize(9);
    EXPECT_THROW(this->world_.terrain.surfacesBelow(this->points_, this->found_), BrokenAssert);
    EXPECT_THROW(this->world_.terrain.restingHeights(this->points_, this->radii_, this->found_),
                 BrokenAssert);
    this->found_.resize(10);
    this->radii_.resize(9);
    EXPECT_THROW(this->world_.terrain.restingHeights(this->points_, this->radii_, this->found_),
                 BrokenAssert);
}

}  // namespace
}  // namespace hashphase::test
