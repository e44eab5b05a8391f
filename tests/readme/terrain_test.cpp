// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/terrain.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(TerrainPage, GroundLiesBelow) {
    const std::vector<Point> vertices{{-50, 0, 50}, {50, 0, 50}, {0, 10, -50}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 1, 3};
    const Point point(0, 50, 0);
    const Point& center = point;
    const float radius = 1;
    const std::vector<Point> centers{point};
    const std::vector<float> radii{radius};
    std::size_t warned = 0;
    const auto warn = [&](std::size_t count) { warned = count; };
    float stoodAt = 0;
    const auto stand = [&](float height, const Point& /*normal*/) { stoodAt = height; };
    float settledAt = 0;
    const auto settle = [&](float height) { settledAt = height; };
#include <terrain_1.inl>
    EXPECT_EQ(warned, 1U);
#include <terrain_2.inl>
    EXPECT_FLOAT_EQ(stoodAt, 5);
    stoodAt = 0;
    const float mostClimb = 0.5F;
#include <terrain_3.inl>
    EXPECT_FLOAT_EQ(stoodAt, 5);
#include <terrain_4.inl>
    EXPECT_GT(settledAt, 6);
#include <terrain_5.inl>
    ASSERT_TRUE(found[0]);
    EXPECT_EQ(found[0]->height, settledAt);
}

TEST(TerrainPage, GroundChanges) {
    const std::vector<Point> vertices{{-50, 0, 50}, {50, 0, 50}, {0, 10, -50}};
    const std::vector<Point> raised{{-50, 1, 50}, {50, 1, 50}, {0, 11, -50}};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    Grid<float> ground;
    Terrain<float> terrain(ground);
#include <terrain_6.inl>
    EXPECT_EQ(ground.size(), 0U);

    terrain.add(vertices, indices);
    Grid<float> bodies;
    const ProxyId low = bodies.add(boxAround<float>({0, 1, 0}, 1));
    static_cast<void>(bodies.add(boxAround<float>({0, 30, 0}, 1)));
    const Point blast(1, 2, 1);
    const float radius = 2;
    std::vector<ProxyId> woken;
    const auto wake = [&](ProxyId id) { woken.push_back(id); };
#include <terrain_7.inl>
    EXPECT_EQ(ground.size(), 0U);
    EXPECT_EQ(woken, std::vector<ProxyId>{low});
}

TEST(TerrainPage, BulletsTrianglesAreTaken) {
    const std::array<float, 4> heights{0, 0, 0, 0};
    const btHeightfieldTerrainShape shape(2, 2, heights.data(), btScalar(0), btScalar(1), 1, false);
    Grid<btScalar> ground;
    Terrain<btScalar> terrain(ground);
#include <terrain_8.inl>
    EXPECT_EQ(error, "");
    EXPECT_EQ(terrain.size(), 2U);
#include <terrain_9.inl>
    EXPECT_LT(terrain.seamTolerance({0, 0, 0}), 0.001F);
}

}  // namespace
}  // namespace hashphase::test
