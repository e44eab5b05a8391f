// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory.

#include <tests/integration/all_clients.hpp>
#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace hashphase::test {
namespace {

/// Bodies that swing about their homes.
struct SwingingBodies {
    static constexpr int kPeriod = 126;  // frames

    SwingingBodies() {
        for (int i = 0; i < 2000; ++i) {
            homes.push_back(random.pointIn(-20, 20));
            ids.push_back(grid.add(boxAround<float>(homes.back(), {0.5, 0.5, 0.5})));
        }
    }
    void play(int frame) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const double turn = 2 * std::numbers::pi * (frame % kPeriod) / kPeriod;
            const double swing = std::sin(turn + static_cast<double>(i));
            const Vector3<double> offset = Vector3<double>::Constant(swing);
            grid.move(ids[i], boxAround<float>(homes[i] + offset, {0.5, 0.5, 0.5}));
        }
        grid.update();
    }

    Random random{0x5eed0f01};
    Grid<float> grid;
    std::vector<ProxyId> ids;
    std::vector<Vector3<double>> homes;
};

TEST(SteadyFrame, OfAllClientsAllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    SwingingBodies bodies;
    std::vector<Vector3<float>> eyes;
    for (int i = 0; i < 50; ++i) {
        eyes.push_back(bodies.random.pointIn(-20, 20).cast<float>());
    }
    AllClients<float> clients(
        eyes, 2000, [](ProxyId id) { return id.index % 3 != 0; },
        [](ProxyId id) { return id.index % 50 == 0; });
    int frame = 0;
    // By then the grid has given back what the first ones took.
    while (frame < 3 * SwingingBodies::kPeriod) {
        bodies.play(frame++);
        clients.ask(bodies.grid);
    }
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    std::size_t found = 0;
    while (frame < 5 * SwingingBodies::kPeriod) {
        bodies.play(frame++);
        clients.ask(bodies.grid);
        found += clients.size();
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(found, SwingingBodies::kPeriod * 200U);
}

template <class Scalar>
class TerrainQueries : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainQueries, Scalars);

TYPED_TEST(TerrainQueries, AllocateNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    Random random(0x5eed2401);
    const GroundWorld<TypeParam> world(roughGround<TypeParam>(random, 60, 1, 3, 0.15));
    std::vector<Vector3<TypeParam>> points;
    const std::vector<TypeParam> radii(20000, TypeParam(0.8));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        points.push_back(random.pointIn({0, 0, 0}, {60, 5, 60}).template cast<TypeParam>());
    }
    std::vector<std::optional<Ground<TypeParam>>> found(points.size());
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    world.terrain.surfacesBelow(points, found);
    world.terrain.restingHeights(points, radii, found);
    for (const Vector3<TypeParam>& point : points) {
        static_cast<void>(world.terrain.surfaceBelow(point));
    }
    EXPECT_EQ(allocationCount(), before);
}

}  // namespace
}  // namespace hashphase::test
