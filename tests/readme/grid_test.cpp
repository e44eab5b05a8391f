// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/grid.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(GridPage, PairsAndQueriesAnswer) {
#include <grid_1.inl>
    EXPECT_EQ(born.size(), 1U);
    EXPECT_TRUE(died.empty());

    const std::vector<std::pair<ProxyId, Aabb<float>>> moved{{wall, cubeAt(9, 0, 0)}};
    const auto filter = [](ProxyId, ProxyId) { return true; };
    const auto begin = [](ProxyId, ProxyId) { FAIL() << "Nothing has come together."; };
    int ended = 0;
    const auto end = [&](ProxyId, ProxyId) { ++ended; };
    {
#include <grid_2.inl>
    } EXPECT_EQ(ended, 1);
    {
#include <grid_3.inl>
        EXPECT_EQ(closest.found(), ball);
        EXPECT_GT(cost.boxesTested, 0U);
        EXPECT_EQ(found, std::vector<ProxyId>{ball});
        ASSERT_EQ(nearest.size(), 1U);
        EXPECT_EQ(nearest.front().id, wall);
    }
    int greeted = 0;
    const auto greet = [&](ProxyId, ProxyId) { ++greeted; };
#include <grid_5.inl>
    EXPECT_EQ(greeted, 1);
}

TEST(GridPage, CollectorOfYoursIsAsked) {
    Grid<float> grid;
    const ProxyId light = grid.add(cubeAt(0, 0, 0));
    const ProxyId heavy = grid.add(cubeAt(1, 0, 0));
    const std::vector<float> mass{1, 2};
#include <grid_4.inl>
    EXPECT_EQ(heaviest.id, heavy);
}

}  // namespace
}  // namespace hashphase::test
