// SPDX-License-Identifier: Zlib

// What callbacks of the AI's clients may not do to these.

#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hashphase::test {
namespace {

#if HASHPHASE_ENABLE_ASSERTS

/// A few boxes around the origin.
class AiMisuse : public testing::Test {
protected:
    AiMisuse() {
        for (int i = 0; i < 3; ++i) {
            static_cast<void>(grid_.add(makeBox<float>(i, 0, 0, i + 1, 1, 1)));
        }
    }

    const ThrowingAsserts throwing_;
    Grid<float> grid_;
    int calls_ = 0;
};

TEST_F(AiMisuse, OfZonesByTheirFilterIsAsserted) {
    Zones<float> zones;
    const ZoneId id = zones.add({SphereRegion<float>({0, 0, 0}, 9)});
    const auto filter = [&](ZoneId, ProxyId) {
        ++calls_;
        EXPECT_THROW(static_cast<void>(zones.add({})), BrokenAssert);
        EXPECT_THROW(zones.set(id, {}), BrokenAssert);
        EXPECT_THROW(zones.remove(id), BrokenAssert);
        EXPECT_THROW(zones.update(grid_), BrokenAssert);
        return true;
    };
    EXPECT_EQ(zones.update(grid_, filter).entered.size(), 3U);
    EXPECT_EQ(calls_, 3);
    zones.remove(id);
    EXPECT_EQ(zones.update(grid_).left.size(), 3U);
}

TEST_F(AiMisuse, OfARadarByItsGroupsIsAsserted) {
    Radar<float> radar;
    const RadarWindow<float> window{.center = {0, 0, 0}, .cellSize = 10, .columns = 3, .rows = 3};
    const auto groupOf = [&](ProxyId) {
        ++calls_;
        EXPECT_THROW(radar.scan(grid_, window, 1, [](ProxyId) { return 0U; }), BrokenAssert);
        return 0U;
    };
    EXPECT_EQ(radar.scan(grid_, window, 1, groupOf).size(), 9U);
    EXPECT_EQ(calls_, 3);
}

TEST_F(AiMisuse, OfSightByItsFilterIsAsserted) {
    Sight<float> sight;
    const std::vector<Viewer<float>> viewers(
        2, {.eye = {0, 0, 5}, .direction = {0, 0, -1}, .range = 50, .halfAngle = 1});
    const auto filter = [&](ProxyId) {
        ++calls_;
        EXPECT_THROW(sight.look(grid_, viewers), BrokenAssert);
        return true;
    };
    sight.look(grid_, viewers, filter);
    EXPECT_GE(calls_, 6);
}

#endif

}  // namespace
}  // namespace hashphase::test
