// SPDX-License-Identifier: Zlib

// The tree that rays read, its kernel, and the ray as it reads it.

#include <broadphase/search/ray_search.hpp>
#include <broadphase/simd/kernels.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace hashphase::detail {
namespace {

using test::allBoxScenes;
using test::boxAround;
using test::BoxScene;
using test::makeBox;
using test::Random;

template <class Scalar>
class BoxTreeTest : public testing::Test {
protected:
    using Box = Aabb<Scalar>;
    using Ray = RayRegion<Scalar>;

    void build(std::vector<Box> boxes) {
        std::erase_if(boxes, [](const Box& box) { return hasNan(box); });
        boxes_ = std::move(boxes);
        test::fill(table_, boxes_);
        tree_.build(table_);
        ASSERT_EQ(tree_.validate(), "");
    }

    /// Slots that the search offers, in its order.
    std::vector<std::uint32_t> search(const Ray& ray, double limit = 1) {
        std::vector<std::uint32_t> found;
        cost_ = {};
        const auto take = [&](std::span<const std::uint32_t> slots) {
            found.insert(found.end(), slots.begin(), slots.end());
            return limit;
        };
        EXPECT_TRUE(searchRay(tree_, ray, limit, take, cost_));
        return found;
    }

    /// The same, sorted.
    std::vector<std::uint32_t> walk(const Ray& ray, double limit = 1) {
        std::vector<std::uint32_t> slots = search(ray, limit);
        std::sort(slots.begin(), slots.end());
        EXPECT_EQ(std::adjacent_find(slots.begin(), slots.end()), slots.end());
        return slots;
    }

    /// All that the region's key() finds is offered. Returns how much more is.
    std::size_t expectNoneMissed(const Ray& ray, double limit = 1) {
        const std::vector<std::uint32_t> offered = walk(ray, limit);
        std::size_t found = 0;
        for (std::uint32_t slot = 0; slot < boxes_.size(); ++slot) {
            const Scalar key = ray.key(boxes_[slot]);
            if (key >= 0 && static_cast<double>(key) <= limit) {
                ++found;
                EXPECT_TRUE(std::binary_search(offered.begin(), offered.end(), slot))
                    << "box " << boxes_[slot].min().transpose() << ", "
                    << boxes_[slot].max().transpose() << "; ray from " << ray.from().transpose()
                    << " along " << ray.direction().transpose();
            }
        }
        EXPECT_LE(offered.size(), cost_.boxesTested);
        return offered.size() - found;
    }

    std::vector<Box> boxes_;
    Table<Scalar> table_;
    BoxTree tree_;
    QueryCost cost_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BoxTreeTest, Scalars);

TYPED_TEST(BoxTreeTest, OffersARayAllThatItsKeyFindsInEveryScene) {
    Random random(0x5eed0a01);
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        std::vector<Aabb<TypeParam>> boxes;
        for (std::uint32_t i = 0; i < 2 * scene.count; ++i) {
            boxes.push_back(scene.draw(random));
        }
        this->build(std::move(boxes));
        const auto corner = [&] {
            const auto& box =
                this->boxes_[random.below(static_cast<std::uint32_t>(this->boxes_.size()))];
            return random.chance(0.5) ? box.min() : box.max();
        };
        for (int i = 0; i < 400 && !this->HasFailure(); ++i) {
            const Vector3<TypeParam> from = corner();
            Vector3<TypeParam> to = random.chance(0.1) ? from : corner();
            to[random.below(3)] = from[random.below(3)];
            const Vector3<TypeParam> half = (corner() - corner()).cwiseAbs();
            const TypeParam thick = random.chance(0.5) ? TypeParam(0) : TypeParam(0.25);
            this->expectNoneMissed({from, to, {-half * thick, half * thick}},
                                   random.chance(0.5) ? 1 : random.unit());
        }
    }
}

TYPED_TEST(BoxTreeTest, OffersHardlyMoreThanItsKeyFinds) {
    Random random(0x5eed0a02);
    for (const double middle : {0.0, 1e5}) {
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 3000; ++i) {
            boxes.push_back(boxAround<TypeParam>(random.pointIn(middle - 30, middle + 30),
                                                 random.pointIn(0.25, 0.75)));
        }
        this->build(std::move(boxes));
        std::size_t more = 0;
        std::size_t tested = 0;
        for (int i = 0; i < 300; ++i) {
            more += this->expectNoneMissed(
                {random.pointIn(middle - 30, middle + 30).template cast<TypeParam>(),
                 random.pointIn(middle - 30, middle + 30).template cast<TypeParam>()});
            tested += this->cost_.boxesTested;
        }
        EXPECT_LT(more, 300 * (sizeof(TypeParam) == sizeof(float) && middle > 0 ? 5U : 1U));
        EXPECT_LT(tested, 300U * 200U);
    }
}

TYPED_TEST(BoxTreeTest, HoldsAnyNumberOfBoxes) {
    Random random(0x5eed0a03);
    for (const std::size_t count :
         {0U, 1U, 2U, 7U, 8U, 9U, 63U, 64U, 65U, 511U, 512U, 513U, 4097U}) {
        SCOPED_TRACE(count);
        std::vector<Aabb<TypeParam>> boxes;
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(boxAround<TypeParam>(random.pointIn(-9, 9), random.pointIn(0, 1)));
        }
        this->build(std::move(boxes));
        const Vector3<TypeParam> half = Vector3<TypeParam>::Constant(99);
        EXPECT_EQ(this->walk({{0, 0, 0}, {1, 2, 3}, {-half, half}}).size(), count);
        for (int i = 0; i < 20; ++i) {
            this->expectNoneMissed(
                {random.pointIn(-9, 9).cast<TypeParam>(), random.pointIn(-9, 9).cast<TypeParam>()});
        }
    }
}

TYPED_TEST(BoxTreeTest, HoldsBoxesAtOnePlaceAndOnALine) {
    for (const bool onALine : {false, true}) {
        std::vector<Aabb<TypeParam>> boxes;
        for (int i = 0; i < 1000; ++i) {
            const double x = onALine ? i * 1000 : 5;
            boxes.push_back(makeBox<TypeParam>(x, 5, 5, x, 5, 5));
        }
        this->build(std::move(boxes));
        EXPECT_EQ(this->walk({{-10, 5, 5}, {1000000, 5, 5}}).size(), 1000U);
        this->expectNoneMissed({{0, 0, 0}, {10, 10, 10}});
        EXPECT_EQ(this->walk({{-10, 6, 5}, {1000000, 6, 5}}).size(), 0U);
    }
}

TYPED_TEST(BoxTreeTest, LeavesOutWhatWasErased) {
    Random random(0x5eed0a04);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 200; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(-5, 5), random.pointIn(0, 1)));
    }
    this->build(std::move(boxes));
    for (std::uint32_t entry = 0; entry < 200; entry += 2) {
        this->table_.erase(entry);
    }
    this->tree_.build(this->table_);
    EXPECT_EQ(this->tree_.validate(), "");
    const Vector3<TypeParam> half = Vector3<TypeParam>::Constant(99);
    EXPECT_EQ(this->walk({{0, 0, 0}, {1, 2, 3}, {-half, half}}).size(), 100U);
}

TYPED_TEST(BoxTreeTest, PassesByWhatIsFarApartAtItsTop) {
    // Two piles: a ray between them reads the top, and not the blocks of either.
    Random random(0x5eed0a05);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 2000; ++i) {
        const double at = i % 2 == 0 ? -4000 : 4000;
        boxes.push_back(
            boxAround<TypeParam>(random.pointIn(at - 5, at + 5), Vector3<double>(1, 1, 1)));
    }
    this->build(std::move(boxes));
    std::uint64_t blocks = 0;
    for (int i = 0; i < 100; ++i) {
        this->walk({random.pointIn(-3000, 3000).cast<TypeParam>(),
                    random.pointIn(-3000, 3000).cast<TypeParam>()});
        blocks += this->cost_.rowsVisited;
    }
    EXPECT_LT(blocks, 300U);
}

TYPED_TEST(BoxTreeTest, ReadsOnlyThePartOfAVeryLongRayThatIsNear) {
    Random random(0x5eed0a06);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 1000; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(-50, 50), Vector3<double>(1, 1, 1)));
    }
    this->build(std::move(boxes));
    const double exact = sizeof(TypeParam) == sizeof(float) ? 1e4 : 1e12;
    for (int i = 0; i < 100; ++i) {
        const Vector3<double> middle = random.pointIn(-40, 40);
        const Vector3<double> way = random.pointIn(-exact, exact);
        const auto half = static_cast<TypeParam>(0.5);
        const Vector3<TypeParam> from = (middle - way).cast<TypeParam>();
        this->expectNoneMissed({from, (middle + way).cast<TypeParam>()});
        EXPECT_LT(this->cost_.boxesTested, 500U);
        // To the middle only, in the ray's own fractions.
        this->expectNoneMissed({from, (middle + way).cast<TypeParam>()}, static_cast<double>(half));
    }
}

TYPED_TEST(BoxTreeTest, OffersBoxesInBlocksFromNearToFarUntilToldToStop) {
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 1000; ++i) {
        boxes.push_back(boxAround<TypeParam>({i + 0.5, 0, 0}, {0.25, 1, 1}));
    }
    this->build(std::move(boxes));
    const RayRegion<TypeParam> ray({-10, 0, 0}, {1100, 0, 0});
    std::size_t all = 0;
    QueryCost wholeCost;
    const auto takeAll = [&](std::span<const std::uint32_t> slots) {
        EXPECT_TRUE(std::is_sorted(slots.begin(), slots.end()));
        EXPECT_LE(slots.size(), kBlockWidth);
        all += slots.size();
        return 1.0;
    };
    EXPECT_TRUE(searchRay(this->tree_, ray, 1, takeAll, wholeCost));
    EXPECT_EQ(all, 1000U);
    for (const double end : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        std::size_t offered = 0;
        QueryCost cost;
        const auto take = [&](std::span<const std::uint32_t> slots) {
            offered += slots.size();
            return offered < 20 ? 1.0 : end;
        };
        EXPECT_FALSE(searchRay(this->tree_, ray, 1, take, cost));
        EXPECT_GE(offered, 20U);
        EXPECT_LT(offered, 20 + kBlockWidth);
        EXPECT_EQ(cost.boxesTested, offered);
    }
}

TYPED_TEST(BoxTreeTest, OffersNothingBeyondALimitThatShrinks) {
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 1000; ++i) {
        boxes.push_back(boxAround<TypeParam>({i + 0.5, 0, 0}, {0.25, 1, 1}));
    }
    this->build(std::move(boxes));
    QueryCost cost;
    std::size_t offered = 0;
    const auto take = [&](std::span<const std::uint32_t> slots) {
        offered += slots.size();
        return 0.1;
    };
    EXPECT_TRUE(
        searchRay(this->tree_, RayRegion<TypeParam>({0, 0, 0}, {1000, 0, 0}), 1, take, cost));
    EXPECT_GE(offered, 100U);
    EXPECT_LT(offered, 120U);
    EXPECT_LT(cost.boxesTested, 130U);
}

TYPED_TEST(BoxTreeTest, IsSearchedInTheSameOrderByEveryInstructionSet) {
    Random random(0x5eed0a08);
    std::vector<Aabb<TypeParam>> boxes;
    for (int i = 0; i < 3000; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(-30, 30), random.pointIn(0, 1)));
    }
    this->build(std::move(boxes));
    const InstructionSet before = instructionSet();
    std::size_t found = 0;
    for (int i = 0; i < 200; ++i) {
        const RayRegion<TypeParam> ray(random.pointIn(-40, 40).template cast<TypeParam>(),
                                       random.pointIn(-40, 40).template cast<TypeParam>());
        useInstructionSet(InstructionSet::scalar);
        const std::vector<std::uint32_t> expected = this->search(ray);
        found += expected.size();
        for (const InstructionSet set :
             {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
            if (isAvailable(set)) {
                useInstructionSet(set);
                EXPECT_EQ(this->search(ray), expected) << nameOf(set);
            }
        }
    }
    useInstructionSet(before);
    EXPECT_GT(found, 100U);
}

// --- Kernel --------------------------------------------------------------------------------------

TEST(RayKernel, GivesTheBitsOfItsScalarTwin) {
    Random random(0x5eed0a07);
    using Limits = std::numeric_limits<float>;
    const std::array<float, 8> special{
        0,      -0.0F,         Limits::infinity(),  1e30F,
        1e-38F, Limits::max(), -Limits::infinity(), Limits::quiet_NaN()};
    const auto number = [&] {
        return random.chance(0.1) ? special[random.below(8)]
                                  : static_cast<float>(random.between(-3, 3));
    };
    const InstructionSet before = instructionSet();
    useInstructionSet(InstructionSet::scalar);
    const auto scalarTwin = kernels<float>().mayMeet;
    useInstructionSet(before);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        TreeNode8 block{};
        for (auto& column : block.bounds) {
            std::generate(std::begin(column), std::end(column), number);
        }
        RayLanes ray{};
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            ray.nearColumn[axis] = axis + (random.chance(0.5) ? 3 : 0);
            ray.farColumn[axis] = 2 * axis + 3 - ray.nearColumn[axis];
            ray.inverse[axis] = number();
            ray.farInverse[axis] = number();
        }
        std::generate(std::begin(ray.offset), std::end(ray.offset), number);
        const float last = number();
        std::array<float, kBlockWidth> enter{};
        std::array<float, kBlockWidth> expected{};
        const std::uint32_t mask = scalarTwin(block, ray, last, expected.data());
        for (const InstructionSet set :
             {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
            if (isAvailable(set)) {
                useInstructionSet(set);
                ASSERT_EQ(kernels<float>().mayMeet(block, ray, last, enter.data()), mask);
                ASSERT_EQ(std::memcmp(enter.data(), expected.data(), sizeof(enter)), 0);
            }
        }
        hits += mask != 0 ? 1 : 0;
    }
    useInstructionSet(before);
    EXPECT_GT(hits, 1000);
}

}  // namespace
}  // namespace hashphase::detail
