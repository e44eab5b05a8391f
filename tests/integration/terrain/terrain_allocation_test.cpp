// SPDX-License-Identifier: Zlib
//
// Asking the ground takes no memory. Adding to it does, and may find that there is none.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainQueries : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainQueries, Scalars);

TYPED_TEST(TerrainQueries, AllocateNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
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

TEST(TerrainOutOfMemory, TrianglesAreAddedAllOrNone) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Growing {
        Grid<float> grid;
        Terrain<float> terrain{grid};
        Mesh<float> mesh = [] {
            Random random(0x5eed2402);
            return roughGround<float>(random, 8, 1, 1, 0.1);
        }();
        Growing() { terrain.add(mesh.corners()); }
    };
    for (const bool hasBad : {false, true}) {
        const std::size_t failures = runOutOfMemory(
            [=] {
                auto growing = std::make_unique<Growing>();
                if (hasBad) {
                    growing->mesh.indices[60] = 12345;
                }
                return growing;
            },
            [](Growing& growing) {
                growing.terrain.add(growing.mesh.vertices, growing.mesh.indices);
            },
            [](Growing& growing, std::size_t) {
                const std::uint32_t before = growing.terrain.size();
                EXPECT_TRUE(before == 128 || before == 256);
                EXPECT_TRUE(growing.grid.size() == before || growing.grid.size() == before - 1);
                EXPECT_EQ(growing.grid.validate(), "");
                growing.terrain.add(growing.mesh.vertices, growing.mesh.indices);
                EXPECT_EQ(growing.terrain.size(), before + 128);
                EXPECT_TRUE(growing.terrain.surfaceBelow({4, 9, 4}).has_value());
                growing.terrain.clear();
                EXPECT_EQ(growing.grid.size(), 0U);
            });
        EXPECT_GE(failures, 3U);
    }
}

}  // namespace
}  // namespace hashphase::test
