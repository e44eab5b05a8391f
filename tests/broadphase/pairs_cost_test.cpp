// SPDX-License-Identifier: Zlib

// What an update does follows what changed, counted rather than timed.

#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

constexpr auto acceptAll = [](ProxyId, ProxyId) { return true; };

/// Boxes of size 1 to 2 with some overlap, spread over a cube.
std::vector<ProxyId> fill(Grid<float>& grid, std::uint32_t count, Random& random) {
    const double side = 2.5 * std::cbrt(count);
    std::vector<ProxyId> ids;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vector3<double> center = random.pointIn(0, side);
        ids.push_back(grid.add(boxAround<float>(center, random.pointIn(0.5, 1))));
    }
    return ids;
}

TEST(PairCost, OfAnUpdateAfterWhichNothingChangedIsZero) {
    Random random(0x5eed0101);
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const std::vector<ProxyId> ids = fill(grid, 3000, random);
    pairs.update(acceptAll);
    for (int i = 0; i < 20; ++i) {
        for (const ProxyId id : ids) {
            grid.move(id, Box(grid.box(id)));
        }
        const PairChanges changes = pairs.update(acceptAll);
        EXPECT_TRUE(changes.born.empty());
        EXPECT_TRUE(changes.died.empty());
        EXPECT_EQ(pairs.lastCost().grid.changed, 0U);
        EXPECT_EQ(pairs.lastCost().grid.filed, 0U);
        EXPECT_EQ(pairs.lastCost().boxesTested, 0U);
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
}

TEST(PairCost, FollowsWhatMovesNotWhatExists) {
    constexpr std::uint32_t kCount = 20000;
    constexpr std::uint32_t kMoving = 50;
    Random random(0x5eed0102);
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const std::vector<ProxyId> ids = fill(grid, kCount, random);
    for (int frame = 0; frame < 40; ++frame) {
        for (std::uint32_t i = 0; i < kMoving; ++i) {
            const ProxyId id = ids[i * 397];
            grid.move(id, shifted(random, grid.box(id), 0.1));
        }
        pairs.update(acceptAll);
        if (frame < 20) {
            continue;
        }
        const PairCost& cost = pairs.lastCost();
        EXPECT_EQ(cost.grid.changed, kMoving);
        EXPECT_LE(cost.grid.filed, 2 * kMoving);
        EXPECT_GE(cost.grid.resting, kCount - 2 * kMoving);
        // Some dozen neighbours each, where a search through all would be a million tests.
        EXPECT_LT(cost.boxesTested, 200 * kMoving);
        EXPECT_LT(cost.pairsWatched, 20 * kMoving);
    }
}

TEST(PairCost, OfStaticProxiesEndsAfterTheSecondUpdate) {
    Random random(0x5eed0103);
    Grid<float> grid;
    Pairs<float> pairs(grid);
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const Vector3<double> center = random.pointIn(0, 50);
        static_cast<void>(grid.add(boxAround<float>(center, {1, 1, 1}), Mobility::resting));
    }
    const ProxyId mover = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    pairs.update(acceptAll);
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(mover, shifted(random, grid.box(mover), 1));
        pairs.update(acceptAll);
        EXPECT_EQ(pairs.lastCost().grid.changed, 1U);
        EXPECT_EQ(pairs.lastCost().grid.resting, 5000U);
        if (frame > 0) {
            EXPECT_EQ(pairs.lastCost().grid.filed, 1U);
            EXPECT_LT(pairs.lastCost().boxesTested, 500U);
        }
    }
}

TEST(PairCost, CountsTheSearchOnBehalfOfProxiesThatWake) {
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId sleeper = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    for (int i = 0; i < 500; ++i) {
        static_cast<void>(grid.add(makeBox<float>(0.5, 0, 0, 1, 1, 1)));
    }
    const ProxyId mover = grid.add(makeBox<float>(-100, 0, 0, -99, 1, 1));
    for (int i = 0; i < 30; ++i) {
        grid.move(mover, makeBox<float>(-100 - i, 0, 0, -99, 1, 1));
        pairs.update(acceptAll);
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
    grid.move(sleeper, makeBox<float>(900, 0, 0, 901, 1, 1));  // to where nothing is
    EXPECT_EQ(pairs.update(acceptAll).died.size(), 500U);
    EXPECT_GE(pairs.lastCost().boxesTested, 500U);
}

TEST(PairCost, MemoryIsGivenAndGrowsWithThePairs) {
    Random random(0x5eed0105);
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const std::size_t empty = pairs.memoryBytes();
    const std::vector<ProxyId> ids = fill(grid, 3000, random);
    pairs.update(acceptAll);
    EXPECT_GE(pairs.memoryBytes(),
              empty + ids.size() * sizeof(Box) + pairs.count() * sizeof(ProxyPair));
    EXPECT_LT(pairs.memoryBytes(), 100 * (ids.size() + pairs.count()) * sizeof(ProxyPair));
}

}  // namespace
}  // namespace hashphase::test
