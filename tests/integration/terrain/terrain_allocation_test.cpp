// SPDX-License-Identifier: Zlib
//
// Asking the ground takes no memory.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hashphase::test
