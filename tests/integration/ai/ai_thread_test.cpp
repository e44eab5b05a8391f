// SPDX-License-Identifier: Zlib

// Agents ask on several threads at the same time, right after many changes, so that the first
// question files them. What goes wrong here is mostly for the thread sanitizer to see.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/ai_oracles.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

using Proxies = std::span<const Placed<float>>;

/// One agent's mind: asks everything, and counts the wrong answers.
struct Mind {
    std::uint64_t seed = 0;
    int wrong = 0;
    Zones<float> zones{};
    ZonesByBruteForce<float> expectedZones{};
    Radar<float> radar{};

    void think(const Grid<float>& grid, Proxies proxies) {
        Random random(++seed);
        RegionMaker<float> make(random, proxies);
        const Vector3<float> position = make.point();
        std::vector<ProxyId> found;
        std::vector<ProxyId> expected;
        findWithin(grid, position, 3, found);
        findWithinByBruteForce(proxies, position, 3.0F, expected);
        wrong += found == expected ? 0 : 1;

        estimateWithin(grid, position, 3, found);
        wrong += std::ranges::includes(found, expected) ? 0 : 1;

        std::vector<KeyedProxy<float>> nearest;
        std::vector<KeyedProxy<float>> expectedNearest;
        findNearest(grid, position, 5, 20, nearest);
        findNearestByBruteForce(proxies, position, 5, 20.0F, expectedNearest);
        wrong += nearest == expectedNearest ? 0 : 1;

        Viewer<float> viewer;
        viewer.eye = position;
        viewer.direction = make.point() - position;
        viewer.halfAngle = 1;
        const auto isBlocker = [](ProxyId id) { return id.index % 7 == 0; };
        visibleFrom(grid, viewer, found, acceptAll, isBlocker);
        visibleFromByBruteForce<float>(proxies, viewer, expected, acceptAll, isBlocker);
        wrong += found == expected ? 0 : 1;

        const Zone<float> zone{make.sphere()};
        expectedZones.set(zones.add(zone), zone);
        const ZoneEvents events = zones.update(grid);
        wrong += std::ranges::equal(events.entered, expectedZones.update(proxies).entered) ? 0 : 1;

        RadarWindow<float> window;
        window.center = position;
        window.cellSize = 2;
        window.columns = 5;
        window.rows = 5;
        const auto groupOf = [](ProxyId id) { return id.index % 2; };
        const auto counts = radar.scan(grid, window, 2, groupOf);
        const auto expectedCounts = scanByBruteForce<float>(proxies, window, 2, groupOf);
        wrong += std::ranges::equal(counts, expectedCounts) ? 0 : 1;
    }
};

TEST(AiThreads, AskEverythingAtTheSameTime) {
    const BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
    GridWorld<float> world;
    Script<float> script(scene, 0x5eed0e01);
    script.begin(world);
    std::vector<Mind> minds(4);
    for (std::size_t i = 0; i < minds.size(); ++i) {
        minds[i].seed = 1000 * i;
    }
    for (int frame = 0; frame < 20; ++frame) {
        std::vector<std::thread> threads;
        for (Mind& mind : minds) {
            threads.emplace_back([&] { mind.think(world.grid, script.proxies()); });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const Mind& mind : minds) {
            ASSERT_EQ(mind.wrong, 0) << "frame " << frame;
        }
        if (frame % 3 != 1) {
            world.grid.update();
        }
        script.playFrame(world);
    }
}

TEST(AiThreads, LookForManyZonesAndViewersAtTheSameTime) {
    const BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
    GridWorld<float> world;
    Script<float> script(scene, 0x5eed0e02);
    script.begin(world);
    RegionMaker<float> make(script.random(), script.proxies());
    Zones<float> zones;
    std::vector<Viewer<float>> viewers(100);
    for (Viewer<float>& viewer : viewers) {
        static_cast<void>(zones.add({make.sphere()}));
        viewer.eye = make.point();
    }
    ThreadedFor threads(4, 0x5eed0e03);
    Sight<float> sight;
    for (int frame = 0; frame < 10; ++frame) {
        script.playFrame(world);
        zones.update(world.grid, acceptAllInZones, allZones, threads);
        script.playFrame(world);
        EXPECT_GT(sight.look(world.grid, viewers, acceptAll, acceptAll, threads).hits, 0U);
    }
}

}  // namespace
}  // namespace hashphase::test
