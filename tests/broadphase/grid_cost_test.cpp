// SPDX-License-Identifier: Zlib

// What queries and updates cost, counted rather than timed.

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>
#include <integration/ai/nearest.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

/// Boxes of two metres on a plain of the given side.
template <class Scalar>
struct Crowd : Population<Scalar> {
    Crowd(std::size_t count, double side) {
        this->addMany(count, [side](Random& drawn) {
            return boxAround<Scalar>(drawn.pointIn({0, 0, 0}, {side, 2, side}), {1, 1, 1});
        });
        this->update();
    }
    void nudge(std::size_t i) { this->moveTo(i, shifted(this->random, this->proxies[i].box, 0.5)); }
    template <class Region>
    std::uint64_t testsFor(const Region& region) const {
        CollectCount count;
        return this->grid.visit(region, count).boxesTested;
    }
    Vector3<double> anyPoint() { return this->random.pointIn({0, 0, 0}, {400, 2, 400}); }
    RayRegion<Scalar> shortRay() {
        const Vector3<double> from = anyPoint();
        return {from.cast<Scalar>(),
                (from + this->random.pointIn(-30, 30)).template cast<Scalar>()};
    }
};

TEST(GridCost, OfWritesAndQueriesInTurnIsNotThatOfARebuildEach) {
    Crowd<float> crowd(30000, 400);
    std::uint64_t tested = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        crowd.nudge(i * 29);
        const RayRegion<float> ray = crowd.shortRay();
        if (i % 100 == 99) {
            crowd.expectLikeBruteForce(ray);
        }
        tested += crowd.testsFor(ray);
    }
    EXPECT_LT(tested / 1000, 1000U);
    // Filed a few times, not a thousand.
    EXPECT_LT(crowd.grid.update().filed, 20 * 30000U);
}

// What filing costs a proxy, in boxes that a query tests in the list of changes.
constexpr double kFiling = 9;

// With c changes before each query and a filing after every k, a query reads c * k / 2 of the list and
// has its share of the filing, kFiling * n / k: the least is at k * k = 2 * kFiling * n / c.
TEST(GridCost, OfChangesAndQueriesInTurnIsLittleMoreThanTheLeast) {
    constexpr std::uint32_t kCount = 10000;
    constexpr std::uint32_t kQueries = 1200;
    for (const std::uint32_t changes : {1U, 6U, 100U}) {
        Crowd<float> crowd(kCount, 400);
        const std::uint64_t filings = crowd.grid.filingCount();
        std::uint64_t tested = 0;
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < kQueries; ++i) {
            for (std::uint32_t j = 0; j < changes; ++j) {
                crowd.nudge(next++ % kCount);
            }
            tested += crowd.testsFor(BoxRegion<float>{crowd.proxies[next % kCount].box});
        }
        const auto filed = static_cast<double>((crowd.grid.filingCount() - filings) * kCount);
        const double least = std::sqrt(2 * kFiling * kCount * changes);
        EXPECT_LT((static_cast<double>(tested) + kFiling * filed) / kQueries, 1.4 * least + 20)
            << changes << " changes a query";
    }
}

TEST(GridCost, OfManyQueriesAfterAChangeOfAllIsAFilingAndLittleMore) {
    Crowd<float> crowd(10000, 400);
    for (const bool together : {false, true}) {
        for (std::size_t i = 0; i < crowd.proxies.size(); ++i) {
            crowd.nudge(i);
        }
        std::vector<BoxRegion<float>> regions;
        for (std::size_t i = 0; i < 1000; ++i) {
            regions.push_back({crowd.proxies[7 * i].box});
        }
        const std::uint64_t filings = crowd.grid.filingCount();
        std::uint64_t tested = 0;
        if (together) {
            std::vector<CollectCount> counts(regions.size());
            tested =
                crowd.grid.visitEach(std::span<const BoxRegion<float>>(regions), std::span(counts))
                    .boxesTested;
        }
        for (std::size_t i = 0; i < regions.size() && !together; ++i) {
            tested += crowd.testsFor(regions[i]);
        }
        EXPECT_EQ(crowd.grid.filingCount(), filings + 1);
        EXPECT_LT(tested, together ? 40000U : 80000U);
        crowd.expectLikeBruteForce(regions.front());
        EXPECT_EQ(crowd.grid.validate(), "");
    }
}

TEST(GridCost, OfExpectedQueriesIsOneFilingIfTheyAreWorthIt) {
    Crowd<float> crowd(3000, 200);
    for (std::size_t i = 0; i < 1000; ++i) {
        crowd.nudge(i);
    }
    const std::uint64_t filings = crowd.grid.filingCount();
    crowd.grid.expectQueries(3);
    EXPECT_EQ(crowd.grid.filingCount(), filings) << "reading the list three times is cheaper";
    crowd.grid.expectQueries(1000);
    crowd.grid.expectQueries(1000);
    EXPECT_EQ(crowd.grid.filingCount(), filings + 1);
    EXPECT_EQ(crowd.grid.validate(), "");
}

TEST(GridCost, OfASmallRegionDoesNotFollowThePopulation) {
    Crowd<double> crowd(30000, 400);
    for (const bool resting : {false, true}) {
        for (int i = 0; i < (resting ? 30 : 0); ++i) {
            crowd.nudge(0);
            crowd.update();
        }
        for (int i = 0; i < 200; ++i) {
            const Vector3<double> at = crowd.anyPoint();
            const Aabb<double> box = boxAround<double>(at, {1, 1, 1});
            EXPECT_LT(crowd.testsFor(BoxRegion<double>{box}), 300U);
            EXPECT_LT(crowd.testsFor(SphereRegion<double>{at, 2}), 400U);
            EXPECT_LT(crowd.testsFor(crowd.shortRay()), 2000U);
        }
    }
}

TEST(GridCost, OfTheClosestOnALongRayIsThatOfTheWayToIt) {
    Crowd<float> crowd(30000, 400);
    std::uint64_t closestTested = 0;
    std::uint64_t allTested = 0;
    for (int i = 0; i < 100; ++i) {
        // Through the whole crowd: the first is met soon.
        const auto z = static_cast<float>(crowd.random.between(10, 390));
        const RayRegion<float> ray({-10, 1, z}, {410, 1, z + 100});
        CollectClosest<float> closest;
        closestTested += crowd.grid.visit(ray, closest).boxesTested;
        allTested += crowd.testsFor(ray);
        EXPECT_FALSE(closest.found().isNull());
    }
    EXPECT_LT(5 * closestTested, allTested);
}

TEST(GridCost, OfAFewEnormousBoxesIsOneTestEach) {
    Crowd<float> crowd(10000, 400);
    const auto testsForRays = [&crowd] {
        std::uint64_t tested = 0;
        for (int i = 0; i < 100; ++i) {
            tested += crowd.testsFor(crowd.shortRay());
        }
        return tested;
    };
    const std::uint64_t without = testsForRays();
    for (int i = 0; i < 5; ++i) {
        crowd.add(makeBox<float>(-1e18, -1e18, -1e18, 1e18, -i, 1e18));
    }
    crowd.update();
    EXPECT_LT(testsForRays(), 2 * without + 500);
}

// Most are swept, and a long one is tested with everyone.
template <class Scalar>
void expectThatACrowdedCellAllocatesNothing() {
    Population<Scalar> crowd(GridConfig{.cellSize = 1e4});
    crowd.addMany(2000, cubesIn<Scalar>(1., 99., 0.3));
    crowd.add(makeBox<Scalar>(20, 20, 20, 75, 75, 75));
    std::size_t before = 0;
    for (int frame = 0; frame < 8; ++frame) {
        before = frame == 4 ? allocationCount() : before;
        const Vector3<Scalar> way(Scalar(frame % 2 == 0 ? 0.5 : -0.5), 0, 0);
        for (std::size_t i = 0; i < crowd.proxies.size(); ++i) {
            crowd.moveTo(i, crowd.proxies[i].box.translated(way));
        }
        ASSERT_GT(crowd.grid.update().largestCell, 1000U);
    }
    EXPECT_EQ(allocationCount(), before);
}

TEST(GridCost, OfACrowdThatMovesIsNoAllocation) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    expectThatACrowdedCellAllocatesNothing<float>();
    expectThatACrowdedCellAllocatesNothing<double>();
}

// --- The most that a query may cost --------------------------------------------------------------

template <class Scalar>
class QueryBounds : public testing::Test {
protected:
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

    /// Boxes of half a metre between the corners, in cells of the given edge.
    struct World : Population<Scalar> {
        std::uint64_t count;
        std::uint32_t largestCell = 0;

        World(std::uint32_t boxes, const Vector3<double>& high, double cellSize)
            : Population<Scalar>(GridConfig{.cellSize = cellSize}), count(boxes) {
            this->addMany(boxes, cubesIn<Scalar>(Vector3<double>(0, 0, 0), high, 0.25));
            largestCell = this->grid.update().largestCell;
        }

        /// Many more boxes, far away, each in a cell of 8 m of its own: that they are not looked
        /// at, and that cells do not begin in the middle of the others.
        void addAnchors() {
            for (std::uint64_t i = 0; i <= count; ++i) {
                const Vector3<double> at(1004 + 20.0 * static_cast<double>(i % 1000),
                                         1004 + 20.0 * static_cast<double>(i / 1000), 1004);
                this->add(boxAround<Scalar>(at, {0.25, 0.25, 0.25}));
            }
            largestCell = this->grid.update().largestCell;
        }
    };

    template <class Region>
    static std::size_t expectOneTestEach(const World& world, const Region& region) {
        CollectCount found;
        const QueryCost cost = world.grid.visit(region, found);
        EXPECT_LE(cost.boxesTested, world.count * 5 / 4);
        EXPECT_LE(cost.rowsVisited, world.count);
        if constexpr (requires { region.bounds(); }) {
            constexpr std::uint64_t times = 5;
            const std::vector<Region> regions(times, region);
            std::vector<CollectCount> each(times);
            const QueryCost sum =
                world.grid.visitEach(std::span<const Region>(regions), std::span(each));
            EXPECT_LE(sum.boxesTested, times * world.count * 5 / 4);
            EXPECT_EQ(each[times - 1].count(), found.count());
        }
        return found.count();
    }

    /// Everything, half of everything, and all that is nearly along the x axis.
    static void expectBounds(const World& world, Scalar length) {
        const auto all = Vector3<Scalar>::Constant(Scalar(1e30)).eval();
        const std::size_t count = world.count;
        const auto zero = Vector3<Scalar>::Zero().eval();
        EXPECT_EQ(expectOneTestEach(world, BoxRegion<Scalar>{{-all, all}}), count);
        EXPECT_EQ(expectOneTestEach(world, SphereRegion<Scalar>(zero, Scalar(1e30))), count);
        EXPECT_EQ(expectOneTestEach(world, SphereRegion<Scalar>(zero, kInfinity)), count);
        EXPECT_EQ(expectOneTestEach(world, PositionRegion<Scalar>(all, kInfinity)), count);
        const CellsRegion<Scalar> cells(zero, Scalar(1e30), world.grid.cellSize());
        EXPECT_EQ(expectOneTestEach(world, cells), count);
        Vector3<Scalar> middle = all;
        middle[0] = length / 2;
        expectOneTestEach(world, BoxRegion<Scalar>{{-all, middle}});
        const RayRegion<Scalar> ray({-length, 1, 1}, {2 * length, 1, 1}, {-all, all});
        EXPECT_EQ(expectOneTestEach(world, ray), count);
        using Plane = typename ConvexRegion<Scalar>::Plane;
        const std::vector<Plane> wedge{Plane(Vector3<Scalar>(1, Scalar(1e-3), 0), -length / 4),
                                       Plane(Vector3<Scalar>(-1, 0, Scalar(1e-2)), 3 * length / 4)};
        for (const std::size_t planes : {0U, 1U, 2U}) {
            for (const Containment part : {Containment::touching, Containment::inside}) {
                expectOneTestEach(world,
                                  ConvexRegion<Scalar>(std::span(wedge).first(planes), part));
            }
        }
        std::vector<KeyedProxy<Scalar>> nearest;
        for (const Vector3<Scalar>& from : {zero, all}) {
            const QueryCost cost = findNearest(world.grid, from, 3, kInfinity, nearest);
            EXPECT_EQ(nearest.size(), 3U);
            EXPECT_LE(cost.boxesTested, 4 * world.count);
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(QueryBounds, Scalars);

TYPED_TEST(QueryBounds, HoldInACube) {
    this->expectBounds({4000, {40, 40, 40}, 0}, 40);
    this->expectBounds({4000, {400, 400, 400}, 1}, 400);
}

// Few rows of cells, and each of them so long that it passes every bucket of a hashed table.
TYPED_TEST(QueryBounds, HoldInALongCorridorOfSmallCells) {
    for (const double length : {1e5, 1e8}) {
        this->expectBounds({4000, {length, 25, 25}, 1}, static_cast<TypeParam>(length));
        this->expectBounds({4000, {length, 4, 4}, 1}, static_cast<TypeParam>(length));
        this->expectBounds({4000, {length, 25, 25}, 0}, static_cast<TypeParam>(length));
    }
}

TYPED_TEST(QueryBounds, HoldForAHundredThousandInOneCell) {
    typename TestFixture::World world(102'000, {1, 1, 1}, 8);
    world.addAnchors();
    ASSERT_GE(world.largestCell, 100'000U);
    const auto corner = makeBox<TypeParam>(0, 0, 0, 0.5, 0.5, 0.5);
    EXPECT_GT(this->expectOneTestEach(world, BoxRegion<TypeParam>{corner}), 1000U);
    EXPECT_GT(this->expectOneTestEach(world, RayRegion<TypeParam>({-1, 0, 0}, {2, 1, 1})), 1000U);
    EXPECT_GT(this->expectOneTestEach(world, SphereRegion<TypeParam>({0, 0, 0}, 1)), 1000U);
    CollectCount inCell;
    EXPECT_LE(world.grid.visitCell({0, 0, 0}, inCell).boxesTested, world.count);
    EXPECT_EQ(inCell.count(), world.count);
}

}  // namespace
}  // namespace hashphase::test
