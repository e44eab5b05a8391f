// SPDX-License-Identifier: Zlib

// What a ray tells of a box, what rays cost a grid that is asked for none, and many regions at once. In which
// boxes rays break is among the hard cases (demos/stability/cases/rays.cpp).

#include <demos/stability/run_together.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using Scalars = testing::Types<float, double>;

template <class Scalar>
class RayQuery : public testing::Test {};
TYPED_TEST_SUITE(RayQuery, Scalars);

/// Slabs in extended precision, for boxes that are not inverted. Returns the interval of t.
template <class Scalar>
std::pair<long double, long double> slabs(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                          const Aabb<Scalar>& box) {
    long double enter = 0;
    long double leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        // As RayRegion has it, the direction is a rounded difference.
        const long double direction = static_cast<Scalar>(to[axis] - from[axis]);
        const long double low = static_cast<long double>(box.min()[axis]) - from[axis];
        const long double high = static_cast<long double>(box.max()[axis]) - from[axis];
        if (direction == 0) {
            if (low > 0 || high < 0) {
                return {1, 0};
            }
            continue;
        }
        enter = std::max(enter, std::min(low / direction, high / direction));
        leave = std::min(leave, std::max(low / direction, high / direction));
    }
    return {enter, leave};
}

TYPED_TEST(RayQuery, KeyMissesNothingAndIsTheFractionOfTheWay) {
    Random random(0x5eed0601);
    constexpr long double epsilon = std::numeric_limits<TypeParam>::epsilon();
    int hits = 0;
    int grazes = 0;
    for (int i = 0; i < 200000; ++i) {
        const double offset = i % 2 == 0 ? 0 : 1000;
        const Aabb<TypeParam> box = boxesIn<TypeParam>(offset - 4, offset + 4, 0, 2)(random);
        const Vector3<TypeParam> from = random.pointIn(offset - 9, offset + 9).cast<TypeParam>();
        Vector3<TypeParam> to = random.pointIn(offset - 9, offset + 9).cast<TypeParam>();
        if (i % 3 == 0) {
            // Through an edge: as close a call as there is.
            Vector3<TypeParam> edge = box.min();
            edge[random.axis()] = box.center()[0];
            to = from + 2 * (edge - from);
        }
        const TypeParam key = RayRegion<TypeParam>(from, to).key(box);
        const auto [enter, leave] = slabs(from, to, box);
        const bool touches = enter <= leave;
        ASSERT_TRUE(key >= 0 || !touches)
            << from.transpose() << " to " << to.transpose() << " misses " << box.min().transpose()
            << ", " << box.max().transpose();
        if (key >= 0) {
            ++hits;
            grazes += touches ? 0 : 1;
            ASSERT_LE(enter, leave + 16 * epsilon);
            ASSERT_LE(std::abs(key - enter), 8 * epsilon);
        }
    }
    EXPECT_GT(hits, 20000);
    EXPECT_LT(grazes, hits / 10);
}

// Along a face, and along an edge.
TYPED_TEST(RayQuery, WithADirectionTooSmallToInvertMeetsWhatItTouches) {
    using Limits = std::numeric_limits<TypeParam>;
    const auto box = makeBox<TypeParam>(0, 0, 0, 1, 1, 1);
    for (const TypeParam tiny : {Limits::denorm_min(), Limits::min(), -Limits::denorm_min()}) {
        EXPECT_GE(RayRegion<TypeParam>({0, 0.5F, -1}, {tiny, 0.5F, 9}).key(box), 0);
        EXPECT_GE(RayRegion<TypeParam>({0, 0, -1}, {tiny, tiny, 9}).key(box), 0);
    }
}

TYPED_TEST(RayQuery, MissesInvertedBoxesWhateverItsDirection) {
    const auto inverted = makeBox<TypeParam>(1, 1, 1, 0, 0, 0);
    for (const Vector3<double>& to :
         {Vector3<double>(0.5, 0.5, 9), Vector3<double>(1, 1, 1), Vector3<double>(0.5, 1, 2)}) {
        const Vector3<TypeParam> from(TypeParam(0.5), TypeParam(0.5), -9);
        EXPECT_LT(RayRegion<TypeParam>(from, to.cast<TypeParam>()).key(inverted), 0);
    }
}

TYPED_TEST(RayQuery, IsEmptyIfAnyOfItsNumbersIsNan) {
    using Point = Vector3<TypeParam>;
    Grid<TypeParam> grid;
    [[maybe_unused]] const ProxyId id = grid.add({Point(-1, -1, -1), Point(1, 1, 1)});
    grid.update();
    for (int number = 0; number <= 12; ++number) {
        std::array<Point, 4> corners{Point(-5, 0, 0), Point(5, 0, 0), Point(-1, -1, -1),
                                     Point(1, 1, 1)};
        if (number < 12) {
            corners[static_cast<std::size_t>(number / 3)][number % 3] =
                std::numeric_limits<TypeParam>::quiet_NaN();
        }
        const RayRegion<TypeParam> ray(corners[0], corners[1], {corners[2], corners[3]});
        CollectCount count;
        const QueryCost cost = grid.visit(ray, count);
        EXPECT_EQ(ray.isEmpty(), number < 12) << number;
        EXPECT_EQ(count.count(), number < 12 ? 0U : 1U) << number;
        EXPECT_EQ(cost.boxesTested, number < 12 ? 0U : 1U) << number;
    }
}

TYPED_TEST(RayQuery, MakesAnewWhatWasFreed) {
    Population<TypeParam> world;
    world.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    world.update();
    for (int round = 0; round < 3; ++round) {
        world.grid.expectRays(10'000);
        EXPECT_EQ(world.expectLikeBruteForce(RayRegion<TypeParam>({-1, 0, 0}, {2, 0, 0})), 1U);
        EXPECT_GT(world.grid.rayMemoryBytes(), 0U);
        world.grid.releaseRayMemory();
        EXPECT_EQ(world.grid.rayMemoryBytes(), 0U);
        EXPECT_EQ(world.grid.validate(), "");
        if (round == 1) {
            world.moveTo(0, makeBox<TypeParam>(0, -1, -1, 1, 1, 1));
            world.update();
        }
    }
}

// --- Many at once --------------------------------------------------------------------------------

/// Two threads, the odd ranges on the second.
void forOnTwoThreads(std::size_t count, std::size_t grain, LoopBody body) {
    const auto run = [&](std::size_t begin) {
        for (; begin < count; begin += 2 * grain) {
            body(begin, std::min(begin + grain, count));
        }
    };
    demos::runTogether(2, [&](std::size_t thread) { run(thread * grain); });
}

template <class Scalar>
class RayBatch : public testing::Test {
protected:
    RayBatch() {
        world_.addMany(3000, boxesIn<Scalar>(-12, 12, 0.25, 0.75), 2);
        world_.update();
    }
    Population<Scalar> world_;
};
TYPED_TEST_SUITE(RayBatch, Scalars);

// Some wait in the list, some have left the table, and the trees are to be made. Boxes at once: tests/fuzz.
TYPED_TEST(RayBatch, FindsForEachRayWhatItFindsAloneInTheSameOrderAtTheSameCost) {
    using Ray = RayRegion<TypeParam>;
    auto& world = this->world_;
    RegionMaker<TypeParam> make(world.random, world.proxies);
    std::vector<Ray> rays;
    for (int i = 0; i < 500; ++i) {
        rays.push_back(make.ray(i % 3 == 0));
    }
    for (const ParallelFor parallelFor : {ParallelFor(serialFor), ParallelFor(forOnTwoThreads)}) {
        for (std::size_t i = 0; i < 3000; i += 75) {
            world.moveTo(i, shifted(world.random, world.proxies[i].box, 2));
        }
        std::vector<std::vector<ProxyId>> found(rays.size());
        std::vector<CollectAll> collectors(found.begin(), found.end());
        const QueryCost cost = world.grid.visitEach(std::span<const Ray>(rays),
                                                    std::span<CollectAll>(collectors), parallelFor);
        QueryCost sum;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            std::vector<ProxyId> alone;
            CollectAll collector(alone);
            sum += world.grid.visit(rays[i], collector);
            ASSERT_EQ(found[i], alone) << i;
        }
        EXPECT_EQ(cost.hits, sum.hits);
        EXPECT_EQ(cost.rowsVisited, sum.rowsVisited);
        EXPECT_EQ(cost.boxesTested, sum.boxesTested);
        EXPECT_GT(cost.hits, 1000U);
    }
    std::vector<CollectCount> none;
    EXPECT_EQ(world.grid.visitEach(std::span<const Ray>(), std::span(none)).hits, 0U);
}

TYPED_TEST(RayBatch, CostsAGridThatIsAskedForNoRaysNothing) {
    const Grid<TypeParam>& grid = this->world_.grid;
    RegionMaker<TypeParam> make(this->world_.random, this->world_.proxies);
    const std::size_t bytes = grid.memoryBytes();
    CollectCount count;
    grid.visit(make.box(), count);
    grid.visit(make.sphere(), count);
    EXPECT_EQ(grid.memoryBytes(), bytes);
    grid.visit(make.ray(), count);
    EXPECT_EQ(grid.memoryBytes(), bytes);
    grid.expectRays(1000);
    const std::size_t withTrees = grid.memoryBytes();
    EXPECT_GT(withTrees, bytes);
    // Trees, and what it takes to make them, are a fixed number of bytes a proxy.
    EXPECT_LT(withTrees, bytes + 160 * 3000);
    this->world_.update();
    grid.expectRays(1000);
    EXPECT_EQ(grid.memoryBytes(), withTrees);
}

// Rays cost what they walk until that is worth a tree, however they come.
TYPED_TEST(RayBatch, GetATreeWhenTheyHaveCostAsMuch) {
    auto& world = this->world_;
    RegionMaker<TypeParam> make(world.random, world.proxies);
    world.grid.expectRays(4);
    CollectCount count;
    std::uint64_t read = 0;
    for (int i = 0; i < 5000 && world.grid.rayMemoryBytes() == 0; ++i) {
        const QueryCost cost = world.grid.visit(make.ray(), count);
        read += 4 * cost.rowsVisited + cost.boxesTested;
    }
    EXPECT_GT(world.grid.rayMemoryBytes(), 0U);
    EXPECT_GE(read, 48U * 3000U);
    EXPECT_LT(read, 48U * 3064U + 2U * 3000U);
    const QueryCost inTree = world.grid.visit(make.ray(), count);
    EXPECT_LT(inTree.boxesTested, 300U);

    std::vector<RayRegion<TypeParam>> rays;
    for (int i = 0; i < 60; ++i) {
        rays.push_back(make.ray());
    }
    for (const std::size_t some : {0U, 40U, 60U}) {
        world.grid.releaseRayMemory();
        std::vector<CollectCount> counts(some);
        world.grid.visitEach(std::span<const RayRegion<TypeParam>>(rays).first(some),
                             std::span(counts), forOnTwoThreads);
        EXPECT_EQ(world.grid.rayMemoryBytes() > 0, some == 60) << some;
    }
}

// A ray from within a ray makes the trees while the outer one walks through the cells.
TYPED_TEST(RayBatch, MayBeginWithinARayThatWalks) {
    auto& world = this->world_;
    const RayRegion<TypeParam> ray({-12, -12, -12}, {12, 12, 12});
    const auto expected = find(world.grid, ray);
    ASSERT_GT(expected.size(), 3U);
    struct Nested {
        const Grid<TypeParam>& grid;
        const RayRegion<TypeParam>& ray;
        CollectKeys<TypeParam> own;
        CollectKeys<TypeParam> inner;

        void add(ProxyId id, TypeParam key) {
            grid.expectRays(1000);
            inner = {};
            grid.visit(ray, inner);
            own.add(id, key);
        }
        [[nodiscard]] static double limit() { return 1; }
    };
    world.grid.releaseRayMemory();
    Nested nested{world.grid, ray, {}, {}};
    world.grid.visit(ray, nested);
    EXPECT_GT(world.grid.rayMemoryBytes(), 0U);
    EXPECT_EQ(differences(nested.own.sorted(), expected), "");
    EXPECT_EQ(differences(nested.inner.sorted(), expected), "");
}

// One of them makes the trees, the others go on in cells or in trees.
TYPED_TEST(RayBatch, FindTheSameOnSeveralThreadsWheneverTheTreesAreMade) {
    auto& world = this->world_;
    RegionMaker<TypeParam> make(world.random, world.proxies);
    std::vector<RayRegion<TypeParam>> rays;
    for (int i = 0; i < 2000; ++i) {
        rays.push_back(make.ray(i % 3 == 0));
    }
    std::vector<std::size_t> counts(rays.size());
    forOnTwoThreads(rays.size(), 10, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            CollectCount count;
            world.grid.visit(rays[i], count);
            counts[i] = count.count();
        }
    });
    EXPECT_GT(world.grid.rayMemoryBytes(), 0U);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        CollectCount expected;
        visitByBruteForce<TypeParam>(world.proxies, rays[i], expected);
        ASSERT_EQ(counts[i], expected.count()) << i;
    }
}

}  // namespace
}  // namespace hashphase::test
