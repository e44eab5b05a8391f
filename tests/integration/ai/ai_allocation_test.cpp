// SPDX-License-Identifier: Zlib
//
// A frame like the last one takes no memory.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hashphase::test {
namespace {

TEST(AiFrame, LikeTheLastOneAllocatesNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "allocations are not counted under a sanitizer";
    }
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
    const std::size_t before = allocationCount();
    ASSERT_GT(before, 0U);
    told = 0;
    for (int number = 2 * kPeriod; number < 3 * kPeriod; ++number) {
        frame(number);
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(told, 500U);
}

}  // namespace
}  // namespace hashphase::test
