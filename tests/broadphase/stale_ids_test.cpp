// SPDX-License-Identifier: Zlib

// An id that is null, or of what is gone, does nothing where assertions are off: to nobody else, and never
// beyond an array.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hashphase::test {
namespace {

Aabb<double> cubeAt(double x) {
    return makeBox<double>(x, 0, 0, x + 1, 1, 1);
}

struct StaleIds : testing::Test {
    StaleIds() {
        for (int i = 0; i < 20; ++i) {
            ids.push_back(grid.add(cubeAt(0.5 * i)));
        }
        pairs.update();
        const ProxyId replaced = ids[3];
        const ProxyId vacant = ids[7];
        grid.remove(replaced);
        pairs.update();
        ids[3] = grid.add(cubeAt(1.5));
        EXPECT_EQ(ids[3].index, replaced.index);
        grid.remove(vacant);
        ids.erase(ids.begin() + 7);
        pairs.update();
        stale = {ProxyId{}, replaced, vacant, ProxyId{1'000'000, 1}};
    }

    std::vector<ProxyId> ids;
    std::array<ProxyId, 4> stale;
    Grid<double> grid;
    Sweeps<double> sweeps{grid};
    Pairs<double> pairs{grid, &sweeps};
};

TEST_F(StaleIds, ChangeNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    const std::size_t pairCount = pairs.count();
    const auto refuse = [](ProxyId, ProxyId) { return false; };
    int calls = 0;
    for (const ProxyId id : stale) {
        grid.move(id, cubeAt(-99));
        grid.remove(id);
        grid.setGroups(id, {2, 4});
        sweeps.set(id, Vector3<double>(9, 0, 0));
        EXPECT_TRUE(grid.groups(id) == ProxyGroups{});
        EXPECT_TRUE(hasNan(grid.box(id)));
        static_cast<void>(grid.cellsOf(id));
        EXPECT_TRUE(hasNan(sweeps.motion(id).box));
        EXPECT_TRUE(pairs.findPairsNow(id, acceptAllPairs).born.empty());
        EXPECT_TRUE(pairs.refilter(id, refuse).died.empty());
        calls += 10;
    }
    EXPECT_TRUE(pairs.refilter(stale, refuse).died.empty());
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? calls : 0);
    const PairChanges changes = pairs.update();
    EXPECT_TRUE(changes.born.empty() && changes.died.empty());
    EXPECT_EQ(pairs.count(), pairCount);
    EXPECT_EQ(grid.size(), ids.size());
    EXPECT_EQ(sweeps.size(), 0U);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(grid.box(ids[i]).min().x(), 0.5 * static_cast<double>(i < 7 ? i : i + 1));
    }
    EXPECT_EQ(grid.validate(), "");
    EXPECT_EQ(pairs.validate(), "");
}

TEST_F(StaleIds, AmongOthersAreLeftOut) {
    const CaughtAsserts caught;
    std::vector<ProxyId> mixed(ids);
    mixed.insert(mixed.end(), stale.begin(), stale.end());
    const std::size_t pairCount = pairs.count();
    EXPECT_EQ(pairs.refilter(mixed, [](ProxyId, ProxyId) { return false; }).died.size(), pairCount);
    EXPECT_EQ(pairs.count(), 0U);
}

// What belongs to the pairs' own calls.
TEST_F(StaleIds, LoseNoPairWhereTheGridIsUpdatedOrClearedBesideItsPairs) {
    const CaughtAsserts caught;
    const std::size_t pairCount = pairs.count();
    const ProxyId fresh = grid.add(cubeAt(0));
    EXPECT_EQ(grid.update().changed, 0U);
    grid.clear();
    EXPECT_TRUE(grid.contains(fresh));
    EXPECT_EQ(pairs.update().born.size(), 3U);
    EXPECT_EQ(pairs.count(), pairCount + 3);
    EXPECT_EQ(pairs.validate(), "");
    EXPECT_EQ(caught.count(), 2);
}

}  // namespace
}  // namespace hashphase::test
