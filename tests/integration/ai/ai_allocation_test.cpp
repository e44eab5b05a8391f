// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory. Counts every `new` of this program.

#include <broadphase/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

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
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace hashphase::test {
namespace {

TEST(AiFrame, LikeTheLastOneAllocatesNothing) {
    Random random(0x5eed0f01);
    Grid<float> grid;
    std::vector<ProxyId> bodies;
    std::vector<Vector3<double>> homes;
    for (int i = 0; i < 2000; ++i) {
        homes.push_back(random.pointIn(-20, 20));
        bodies.push_back(grid.add(boxAround<float>(homes.back(), {0.5, 0.5, 0.5})));
    }
    Zones<float> zones;
    std::vector<Viewer<float>> viewers(50);
    for (Viewer<float>& viewer : viewers) {
        viewer.eye = random.pointIn(-20, 20).cast<float>();
        viewer.range = 8;
        viewer.halfAngle = 1;
        static_cast<void>(zones.add({SphereRegion<float>(viewer.eye, 4)}));
    }
    Sight<float> sight;
    Radar<float> radar;
    std::vector<ProxyId> near;
    std::vector<KeyedProxy<float>> nearest;
    std::size_t told = 0;
    const auto frame = [&](int number) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const double swing = std::sin(0.05 * number + static_cast<double>(i));
            const Vector3<double> offset = Vector3<double>::Constant(swing);
            grid.move(bodies[i], boxAround<float>(homes[i] + offset, {0.5, 0.5, 0.5}));
        }
        grid.update();
        for (const Viewer<float>& viewer : viewers) {
            findWithin(grid, viewer.eye, 5, near);
            estimateWithin(grid, viewer.eye, 5, near);
            findNearest(grid, viewer.eye, 8, 100, nearest);
        }
        sight.look(grid, viewers);
        const ZoneEvents events = zones.update(grid);
        told += events.entered.size() + events.left.size();
        radar.scan(grid, {}, 3, [](ProxyId id) { return id.index % 3; });
    };
    constexpr int kPeriod = 126;
    for (int number = 0; number < 2 * kPeriod; ++number) {
        frame(number);
    }
    const std::size_t before = allocations;
    ASSERT_GT(before, 0U);
    told = 0;
    for (int number = 2 * kPeriod; number < 3 * kPeriod; ++number) {
        frame(number);
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(told, 500U);
}

}  // namespace
}  // namespace hashphase::test

#endif
