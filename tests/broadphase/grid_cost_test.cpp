// SPDX-License-Identifier: Zlib

// What queries and updates cost, counted rather than timed.

#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
struct Crowd {
    Grid<Scalar> grid;
    std::vector<Placed<Scalar>> proxies;
    Random random;

    Crowd(std::uint32_t count, double side, std::uint64_t seed) : random(seed) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vector3<double> at = random.pointIn({0, 0, 0}, {side, 2, side});
            const Aabb<Scalar> box = boxAround<Scalar>(at, {1, 1, 1});
            proxies.push_back({grid.add(box), box});
        }
    }

    void move(std::size_t i) {
        proxies[i].box = shifted(random, proxies[i].box, 0.5);
        grid.move(proxies[i].id, proxies[i].box);
    }

    RayRegion<Scalar> shortRay() {
        const Vector3<double> from = random.pointIn({0, 0, 0}, {400, 2, 400});
        return {from.cast<Scalar>(), (from + random.pointIn(-30, 30)).template cast<Scalar>()};
    }
};

TEST(GridCost, OfWritesAndQueriesInTurnIsNotThatOfARebuildEach) {
    Crowd<float> crowd(30000, 400, 0x5eed0701);
    crowd.grid.update();
    std::uint64_t tested = 0;
    for (int i = 0; i < 1000; ++i) {
        crowd.move(static_cast<std::size_t>(i) * 29);
        const RayRegion<float> ray = crowd.shortRay();
        if (i % 100 == 99) {
            expectLikeBruteForce<float>(crowd.grid, crowd.proxies, ray);
        }
        CollectCount count;
        tested += crowd.grid.visit(ray, count).boxesTested;
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
        Crowd<float> crowd(kCount, 400, 0x5eed0702);
        crowd.grid.update();
        const std::uint64_t filings = crowd.grid.filingCount();
        std::uint64_t tested = 0;
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < kQueries; ++i) {
            for (std::uint32_t j = 0; j < changes; ++j) {
                crowd.move(next++ % kCount);
            }
            const BoxRegion<float> region{crowd.proxies[next % kCount].box};
            CollectCount count;
            tested += crowd.grid.visit(region, count).boxesTested;
        }
        const auto filed = static_cast<double>((crowd.grid.filingCount() - filings) * kCount);
        const double least = std::sqrt(2 * kFiling * kCount * changes);
        EXPECT_LT((static_cast<double>(tested) + kFiling * filed) / kQueries, 1.4 * least + 20)
            << changes << " changes a query";
    }
}

TEST(GridCost, OfManyQueriesAfterAChangeOfAllIsAFilingAndLittleMore) {
    Crowd<float> crowd(10000, 400, 0x5eed0703);
    crowd.grid.update();
    for (const bool together : {false, true}) {
        for (std::size_t i = 0; i < crowd.proxies.size(); ++i) {
            crowd.move(i);
        }
        std::vector<BoxRegion<float>> regions;
        for (std::size_t i = 0; i < 1000; ++i) {
            regions.push_back({crowd.proxies[7 * i].box});
        }
        std::vector<CollectCount> counts(regions.size());
        const std::uint64_t filings = crowd.grid.filingCount();
        std::uint64_t tested = 0;
        if (together) {
            tested =
                crowd.grid.visitEach<BoxRegion<float>, CollectCount>(regions, counts).boxesTested;
        }
        for (std::size_t i = 0; i < regions.size() && !together; ++i) {
            tested += crowd.grid.visit(regions[i], counts[i]).boxesTested;
        }
        EXPECT_EQ(crowd.grid.filingCount(), filings + 1);
        EXPECT_LT(tested, together ? 40000U : 80000U);
        expectLikeBruteForce<float>(crowd.grid, crowd.proxies, regions.front());
        EXPECT_EQ(crowd.grid.validate(), "");
    }
}

TEST(GridCost, OfExpectedQueriesIsOneFilingIfTheyAreWorthIt) {
    Crowd<float> crowd(3000, 200, 0x5eed0704);
    crowd.grid.update();
    for (std::size_t i = 0; i < 1000; ++i) {
        crowd.move(i);
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
    for (const bool resting : {false, true}) {
        Crowd<double> crowd(30000, 400, 0x5eed0702);
        for (int i = 0; i < (resting ? 30 : 1); ++i) {
            crowd.move(0);
            crowd.grid.update();
        }
        for (int i = 0; i < 200; ++i) {
            const Vector3<double> at = crowd.random.pointIn({0, 0, 0}, {400, 2, 400});
            CollectCount inBox;
            const Aabb<double> box = boxAround<double>(at, {1, 1, 1});
            EXPECT_LT(crowd.grid.visit(BoxRegion<double>{box}, inBox).boxesTested, 300U);
            CollectCount inSphere;
            EXPECT_LT(crowd.grid.visit(SphereRegion<double>{at, 2}, inSphere).boxesTested, 400U);
            CollectCount onRay;
            EXPECT_LT(crowd.grid.visit(crowd.shortRay(), onRay).boxesTested, 2000U);
        }
    }
}

TEST(GridCost, OfTheClosestOnALongRayIsThatOfTheWayToIt) {
    Crowd<float> crowd(30000, 400, 0x5eed0703);
    crowd.grid.update();
    std::uint64_t closestTested = 0;
    std::uint64_t allTested = 0;
    for (int i = 0; i < 100; ++i) {
        // Through the whole crowd: the first is met soon.
        const auto z = static_cast<float>(crowd.random.between(10, 390));
        const RayRegion<float> ray({-10, 1, z}, {410, 1, z + 100});
        CollectClosest<float> closest;
        closestTested += crowd.grid.visit(ray, closest).boxesTested;
        CollectCount all;
        allTested += crowd.grid.visit(ray, all).boxesTested;
        EXPECT_FALSE(closest.found().isNull());
    }
    EXPECT_LT(5 * closestTested, allTested);
}

TEST(GridCost, OfAFewEnormousBoxesIsOneTestEach) {
    Crowd<float> crowd(10000, 400, 0x5eed0704);
    crowd.grid.update();
    std::uint64_t without = 0;
    std::uint64_t with = 0;
    for (int i = 0; i < 100; ++i) {
        const RayRegion<float> ray = crowd.shortRay();
        CollectCount count;
        without += crowd.grid.visit(ray, count).boxesTested;
    }
    for (int i = 0; i < 5; ++i) {
        static_cast<void>(crowd.grid.add(makeBox<float>(-1e18, -1e18, -1e18, 1e18, -i, 1e18)));
    }
    crowd.grid.update();
    for (int i = 0; i < 100; ++i) {
        CollectCount count;
        with += crowd.grid.visit(crowd.shortRay(), count).boxesTested;
    }
    EXPECT_LT(with, 2 * without + 500);
}

// Most are swept, and a long one is tested with everyone.
template <class Scalar>
void expectThatACrowdedCellAllocatesNothing() {
    GridConfig config;
    config.cellSize = 1e4;
    Grid<Scalar> grid(config);
    Random random(0x5eed0705);
    std::vector<Placed<Scalar>> proxies;
    for (int i = 0; i < 2000; ++i) {
        const Aabb<Scalar> box =
            boxAround<Scalar>(random.pointIn(1, 99), Vector3<double>::Constant(0.3));
        proxies.push_back({grid.add(box), box});
    }
    const auto longBox = makeBox<Scalar>(20, 20, 20, 75, 75, 75);
    proxies.push_back({grid.add(longBox), longBox});
    std::size_t before = 0;
    for (int frame = 0; frame < 8; ++frame) {
        if (frame == 4) {
            before = allocationCount();
        }
        const Vector3<Scalar> way(Scalar(frame % 2 == 0 ? 0.5 : -0.5), 0, 0);
        for (Placed<Scalar>& placed : proxies) {
            placed.box.translate(way);
            grid.move(placed.id, placed.box);
        }
        ASSERT_GT(grid.update().largestCell, 1000U);
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

}  // namespace
}  // namespace hashphase::test
