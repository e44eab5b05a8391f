// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/ai.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

using AiPage = AgentsBeforeACamera;

TEST_F(AiPage, OneAgentKnowsItsSurroundings) {
    const auto enemies = isEnemy();
    const auto walls = [&](ProxyId id) { return id == wall; };
    float attacked = 0;
    const auto attack = [&](ProxyId /*id*/, float distance) { attacked = distance; };
    {
#include <ai_1.inl>
        EXPECT_EQ(near, std::vector<ProxyId>{enemy});
        EXPECT_EQ(nearest.size(), 1U);
        EXPECT_FLOAT_EQ(attacked, 20);
    }
#include <ai_3.inl>
    EXPECT_EQ(seen, std::vector<ProxyId>{enemy});
#include <ai_5.inl>
    EXPECT_EQ(counts[9 * 9 + 2 * 9 + 4], 1U);  // 20 m ahead, in the middle
}

TEST_F(AiPage, EverybodyKnows) {
    std::size_t pairs = 0;
    const auto flock = [&](ProxyId /*id*/, std::size_t count) { pairs += count; };
#include <ai_2.inl>
    EXPECT_EQ(pairs, 4U);
    EXPECT_EQ(counts[0] + counts[1] + counts[2], 4U);
}

TEST_F(AiPage, ZonesTellWhoEnters) {
    const ProxyId swimmer = grid.add(cubeAt(20, 0, 0));
    std::vector<ProxyId> burnt;
    const auto burn = [&](ProxyId id) { burnt.push_back(id); };
#include <ai_4.inl>
    EXPECT_EQ(burnt, std::vector<ProxyId>{swimmer});
    EXPECT_EQ(zones.occupants(lava).size(), 1U);
}

}  // namespace
}  // namespace hashphase::test
