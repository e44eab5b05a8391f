// SPDX-License-Identifier: Zlib
//
// Asking the ground takes no memory. Counts every `new` of this program.

#include <tests/integration/terrain/meshes.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

// Sanitizers have a `new` of their own, which finds faults that this one would hide.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainQueries : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainQueries, Scalars);

TYPED_TEST(TerrainQueries, AllocateNothing) {
    Random random(0x5eed2401);
    const GroundWorld<TypeParam> world(roughGround<TypeParam>(random, 60, 1, 3, 0.15));
    std::vector<Vector3<TypeParam>> points;
    const std::vector<TypeParam> radii(20000, TypeParam(0.8));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        points.push_back(random.pointIn({0, 0, 0}, {60, 5, 60}).template cast<TypeParam>());
    }
    std::vector<std::optional<Ground<TypeParam>>> found(points.size());
    const std::size_t before = allocations;
    ASSERT_GT(before, 0U);
    world.terrain.surfacesBelow(points, found);
    world.terrain.restingHeights(points, radii, found);
    for (const Vector3<TypeParam>& point : points) {
        static_cast<void>(world.terrain.surfaceBelow(point));
    }
    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace hashphase::test

#endif
