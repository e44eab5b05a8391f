// SPDX-License-Identifier: Zlib

// What callers may not do is asserted, and does nothing.

#include <tests/integration/distributed/rank_world.hpp>
#include <tests/support/handlers.hpp>

#include <stdexcept>

namespace hashphase::test {
namespace {

TEST(RankGridMisuse, OfAnIdThatIsTakenIsRefused) {
    RankGrid<float> grid(0, {});
    grid.add(GlobalId{5}, makeBox<float>(0, 0, 0, 1, 1, 1));
    EXPECT_THROW(grid.add(GlobalId{5}, makeBox<float>(0, 0, 0, 1, 1, 1)), std::invalid_argument);
    EXPECT_EQ(1U, grid.size());
}

TEST(RankGridMisuse, OfAConfigurationIsRefused) {
    RankGridConfig config;
    config.payloadBytes = 65'537;
    EXPECT_THROW(RankGrid<float>(0, {}, config), std::invalid_argument);
    config = {};
    config.grid.cellSize = -1;
    EXPECT_THROW(RankGrid<float>(0, {}, config), std::invalid_argument);
}

#if HASHPHASE_ENABLE_ASSERTS

TEST(RankGridMisuse, OfTheFrameIsAsserted) {
    const ThrowingAsserts throwing;
    RankGrid<float> grid(0, {});
    const Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
    const ProxyId id = grid.add(GlobalId{1}, box);
    EXPECT_THROW(grid.finish({}), BrokenAssert);
    grid.pack();
    EXPECT_THROW(grid.pack(), BrokenAssert);
    EXPECT_THROW(grid.add(GlobalId{2}, box), BrokenAssert);
    EXPECT_THROW(grid.move(id, box), BrokenAssert);
    EXPECT_THROW(grid.remove(id), BrokenAssert);
    EXPECT_THROW(static_cast<void>(grid.payload(id)), BrokenAssert);
    EXPECT_THROW(grid.setPartition({}), BrokenAssert);
    grid.finish({});
    grid.move(id, makeBox<float>(1, 0, 0, 2, 1, 1));
}

TEST(RankGridMisuse, OfGhostsAndStaleIdsIsAsserted) {
    const ThrowingAsserts throwing;
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}));
    const GlobalId object = world.add(0, makeBox<float>(-1, 0, 0, 1, 1, 1));
    world.update();
    RankGrid<float>& other = *world.ranks[1];
    const ProxyId ghost = other.find(object);
    ASSERT_FALSE(ghost.isNull());
    EXPECT_THROW(other.move(ghost, makeBox<float>(0, 0, 0, 1, 1, 1)), BrokenAssert);
    EXPECT_THROW(other.remove(ghost), BrokenAssert);
    const ProxyId mine = world.ranks[0]->find(object);
    world.ranks[0]->remove(mine);
    EXPECT_THROW(world.ranks[0]->move(mine, makeBox<float>(0, 0, 0, 1, 1, 1)), BrokenAssert);
    EXPECT_TRUE(world.ranks[0]->readPayload(mine).empty());
}

TEST(RankGridMisuse, OfAPartitionOfOtherRanksIsAsserted) {
    const ThrowingAsserts throwing;
    RankGrid<float> grid(0, {});
    EXPECT_THROW(grid.setPartition(Partition<float>(std::vector<Cut<float>>{{0, 0}})),
                 BrokenAssert);
}

#endif

}  // namespace
}  // namespace hashphase::test
