// SPDX-License-Identifier: Zlib

// The tree that rays read, its kernel, and the ray as it reads it. In all its boxes, rays walk through the
// cells, too.

#include <broadphase/search/ray_search.hpp>
#include <broadphase/search/ray_walk.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/tree/box_tree.hpp>
#include <broadphase/tree/hilbert.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::boxesIn;
using test::BoxScene;
using test::cubesIn;
using test::drawBoxes;
using test::makeBox;
using test::Random;

template <class Scalar>
class BoxTreeTest : public testing::Test {
protected:
    using Box = Aabb<Scalar>;
    using Ray = RayRegion<Scalar>;
    using Slots = std::vector<std::uint32_t>;

    void build(std::vector<Box> boxes) {
        std::erase_if(boxes, [](const Box& box) { return hasNan(box); });
        boxes_ = std::move(boxes);
        test::fill(table_, boxes_);
        tree_.build(table_);
        ASSERT_EQ(tree_.validate(), "");
    }
    template <class Draw>
    void buildOf(std::size_t count, Draw draw) {
        build(drawBoxes<Scalar>(random_, count, draw));
    }
    /// Along the x axis, a metre apart.
    void buildRow() {
        std::vector<Box> boxes;
        for (int i = 0; i < 1000; ++i) {
            boxes.push_back(boxAround<Scalar>({i + 0.5, 0, 0}, {0.25, 1, 1}));
        }
        build(std::move(boxes));
    }
    Vector3<Scalar> pointIn(double low, double high) {
        return random_.pointIn(low, high).template cast<Scalar>();
    }

    /// Slots that the search offers, in its order.
    Slots search(const Ray& ray, double limit = 1) {
        Slots found;
        cost_ = {};
        const auto take = [&](std::span<const std::uint32_t> slots) {
            found.insert(found.end(), slots.begin(), slots.end());
            return limit;
        };
        EXPECT_TRUE(searchRay(tree_, ray, limit, take, cost_));
        return found;
    }
    /// The same, sorted.
    Slots walk(const Ray& ray, double limit = 1) {
        Slots slots = search(ray, limit);
        std::sort(slots.begin(), slots.end());
        EXPECT_EQ(std::adjacent_find(slots.begin(), slots.end()), slots.end());
        return slots;
    }
    /// Those that the cells offer, each once, sorted.
    Slots walkCells(const Ray& ray, double limit) {
        Slots slots;
        QueryCost cost;
        const auto take = [&](std::span<const std::uint32_t> some) {
            slots.insert(slots.end(), some.begin(), some.end());
            return limit;
        };
        EXPECT_TRUE(searchCells(table_, ray, limit, take, cost));
        EXPECT_LE(slots.size(), cost.boxesTested);
        std::sort(slots.begin(), slots.end());
        EXPECT_EQ(std::adjacent_find(slots.begin(), slots.end()), slots.end());
        return slots;
    }
    /// How many a ray is offered that is as thick as the world.
    std::size_t countAll() {
        const auto half = Vector3<Scalar>::Constant(99);
        return walk({{0, 0, 0}, {1, 2, 3}, {-half, half}}).size();
    }

    /// All that the region's key() finds is offered. Returns how much more is.
    std::size_t expectNoneMissed(const Ray& ray, double limit = 1) {
        const Slots offered = walk(ray, limit);
        const Slots offeredByCells = walkCells(ray, limit);
        std::size_t found = 0;
        for (std::uint32_t slot = 0; slot < boxes_.size(); ++slot) {
            const Scalar key = ray.key(boxes_[slot]);
            if (key >= 0 && static_cast<double>(key) <= limit) {
                ++found;
                EXPECT_TRUE(std::binary_search(offered.begin(), offered.end(), slot) &&
                            std::binary_search(offeredByCells.begin(), offeredByCells.end(), slot))
                    << "box " << boxes_[slot].min().transpose() << ", "
                    << boxes_[slot].max().transpose() << "; ray from " << ray.from().transpose()
                    << " along " << ray.direction().transpose();
            }
        }
        EXPECT_LE(offered.size(), cost_.boxesTested);
        return offered.size() - found;
    }

    Random random_{0x5eed0a01};
    std::vector<Box> boxes_;
    Table<Scalar> table_;
    BoxTree tree_;
    QueryCost cost_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BoxTreeTest, Scalars);

TYPED_TEST(BoxTreeTest, OffersHardlyMoreThanItsKeyFinds) {
    for (const double middle : {0.0, 1e5}) {
        this->buildOf(3000, boxesIn<TypeParam>(middle - 30, middle + 30, 0.25, 0.75));
        std::size_t more = 0;
        std::size_t tested = 0;
        for (int i = 0; i < 300; ++i) {
            const Vector3<TypeParam> from = this->pointIn(middle - 30, middle + 30);
            more += this->expectNoneMissed({from, this->pointIn(middle - 30, middle + 30)});
            tested += this->cost_.boxesTested;
        }
        EXPECT_LT(more, 300 * (sizeof(TypeParam) == sizeof(float) && middle > 0 ? 5U : 1U));
        EXPECT_LT(tested, 300U * 200U);
    }
}

TYPED_TEST(BoxTreeTest, HoldsAnyNumberOfBoxes) {
    for (const std::size_t count :
         {0U, 1U, 2U, 7U, 8U, 9U, 63U, 64U, 65U, 511U, 512U, 513U, 4097U}) {
        SCOPED_TRACE(count);
        this->buildOf(count, boxesIn<TypeParam>(-9, 9, 0, 1));
        EXPECT_EQ(this->countAll(), count);
        for (int i = 0; i < 20; ++i) {
            const Vector3<TypeParam> from = this->pointIn(-9, 9);
            this->expectNoneMissed({from, this->pointIn(-9, 9)});
        }
    }
    // Those that were erased are left out.
    for (std::uint32_t entry = 0; entry < 4096; entry += 2) {
        this->table_.erase(entry);
    }
    this->tree_.build(this->table_);
    EXPECT_EQ(this->tree_.validate(), "");
    EXPECT_EQ(this->countAll(), 4097U - 2048U);
}

TYPED_TEST(BoxTreeTest, PassesByWhatIsFarApartAtItsTop) {
    // Two piles: a ray between them reads the top, and not the blocks of either.
    this->buildOf(2000, [i = 0](Random& random) mutable {
        const double at = ++i % 2 == 0 ? -4000 : 4000;
        return cubesIn<TypeParam>(at - 5, at + 5, 1)(random);
    });
    std::uint64_t blocks = 0;
    for (int i = 0; i < 100; ++i) {
        const Vector3<TypeParam> from = this->pointIn(-3000, 3000);
        this->walk({from, this->pointIn(-3000, 3000)});
        blocks += this->cost_.rowsVisited;
    }
    EXPECT_LT(blocks, 300U);
}

TYPED_TEST(BoxTreeTest, ReadsOnlyThePartOfAVeryLongRayThatIsNear) {
    this->buildOf(1000, cubesIn<TypeParam>(-50, 50, 1));
    const double exact = sizeof(TypeParam) == sizeof(float) ? 1e4 : 1e12;
    for (int i = 0; i < 100; ++i) {
        const Vector3<double> middle = this->random_.pointIn(-40, 40);
        const Vector3<double> way = this->random_.pointIn(-exact, exact);
        const RayRegion<TypeParam> ray(Vector3<TypeParam>((middle - way).cast<TypeParam>()),
                                       Vector3<TypeParam>((middle + way).cast<TypeParam>()));
        this->expectNoneMissed(ray);
        EXPECT_LT(this->cost_.boxesTested, 500U);
        this->expectNoneMissed(ray, 0.5);  // to the middle only, in the ray's own fractions
    }
}

TYPED_TEST(BoxTreeTest, OffersBoxesInBlocksFromNearToFarUntilToldToStop) {
    this->buildRow();
    const RayRegion<TypeParam> ray({-10, 0, 0}, {1100, 0, 0});
    for (const double end : {1.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        std::size_t offered = 0;
        QueryCost cost;
        const auto take = [&](std::span<const std::uint32_t> block) {
            EXPECT_TRUE(std::is_sorted(block.begin(), block.end()));
            EXPECT_LE(block.size(), kBlockWidth);
            offered += block.size();
            return offered < 20 ? 1.0 : end;
        };
        EXPECT_EQ(searchRay(this->tree_, ray, 1, take, cost), end == 1);
        EXPECT_GE(offered, end == 1 ? 1000U : 20U);
        EXPECT_LT(offered, end == 1 ? 1001U : 20 + kBlockWidth);
        EXPECT_EQ(cost.boxesTested, offered);
    }
}

TYPED_TEST(BoxTreeTest, OffersNothingBeyondALimitThatShrinks) {
    this->buildRow();
    QueryCost cost;
    std::size_t offered = 0;
    const auto take = [&](std::span<const std::uint32_t> slots) {
        offered += slots.size();
        return 0.1;
    };
    const RayRegion<TypeParam> ray({0, 0, 0}, {1000, 0, 0});
    EXPECT_TRUE(searchRay(this->tree_, ray, 1, take, cost));
    EXPECT_GE(offered, 100U);
    EXPECT_LT(offered, 120U);
    EXPECT_LT(cost.boxesTested, 130U);
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
        std::array<float, kBlockWidth> expected{};
        std::uint32_t mask = 0;
        test::forEachInstructionSet([&](InstructionSet set) {
            std::array<float, kBlockWidth> enter{};
            const auto bits = kernels<float>().mayMeet(block, ray, last, enter.data());
            if (set == InstructionSet::scalar) {
                mask = bits;
                expected = enter;
            }
            ASSERT_EQ(bits, mask);
            ASSERT_EQ(std::memcmp(enter.data(), expected.data(), sizeof(enter)), 0);
        });
        hits += mask != 0 ? 1 : 0;
    }
    EXPECT_GT(hits, 1000);
}

// --- The curve along which boxes are sorted ------------------------------------------------------

TEST(HilbertCurve, VisitsEveryPointOnceAndStepsToANeighbour) {
    for (int bits = 1; bits <= 5; ++bits) {
        const std::uint32_t side = 1U << bits;
        const std::array<int, 3> nowhere{-1, -1, -1};
        std::vector<std::array<int, 3>> points(side * side * side, nowhere);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            const std::array<std::uint32_t, 3> point{i % side, i / side % side, i / side / side};
            const std::uint64_t place = placeOnHilbertCurve(point, bits);
            ASSERT_LT(place, points.size());
            ASSERT_EQ(points[place], nowhere);
            points[place] = {static_cast<int>(point[0]), static_cast<int>(point[1]),
                             static_cast<int>(point[2])};
        }
        for (std::size_t place = 1; place < points.size(); ++place) {
            int steps = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                steps += std::abs(points[place][axis] - points[place - 1][axis]);
            }
            ASSERT_EQ(steps, 1) << "place " << place << " of " << bits << " bits";
        }
    }
}

TEST(HilbertCurve, FillsACubeBeforeItGoesToTheNext) {
    // At any resolution, the place begins with that of the larger cube around.
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const std::array<std::uint32_t, 3> point{i * 2654435761U >> 11, i * 40503U & 0x1fffffU,
                                                 i * 97U};
        const std::uint64_t place = placeOnHilbertCurve(point, kHilbertBits);
        for (int bits = kHilbertBits - 1; bits > 0; --bits) {
            const int shift = kHilbertBits - bits;
            ASSERT_EQ(placeOnHilbertCurve({point[0] >> shift, point[1] >> shift, point[2] >> shift},
                                          bits),
                      place >> (3 * shift));
        }
    }
}

}  // namespace
}  // namespace hashphase::detail
