// SPDX-License-Identifier: Zlib

// What callbacks of the AI's clients may not do to these, and what callers may not.

#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

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

TEST_F(AiMisuse, OfZonesByTheirFilterOrAfterTheyAreRemovedIsAsserted) {
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
    EXPECT_THROW(zones.set(id, {}), BrokenAssert);
    EXPECT_THROW(zones.remove(id), BrokenAssert);
    EXPECT_THROW(static_cast<void>(zones.zone(id)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(zones.occupants(ZoneId{})), BrokenAssert);
}

TEST_F(AiMisuse, OfARadarByItsGroupsOrWithTooManyCountsIsAsserted) {
    Radar<float> radar;
    RadarWindow<float> window{.center = {0, 0, 0}, .cellSize = 10, .columns = 3, .rows = 3};
    const auto nobody = [](ProxyId) { return 0U; };
    const auto groupOf = [&](ProxyId) {
        ++calls_;
        EXPECT_THROW(radar.scan(grid_, window, 1, nobody), BrokenAssert);
        return 0U;
    };
    EXPECT_EQ(radar.scan(grid_, window, 1, groupOf).size(), 9U);
    EXPECT_EQ(calls_, 3);
    window.columns = window.rows = 1U << 31;
    window.layers = 4;
    EXPECT_THROW(radar.scan(grid_, window, 1, nobody), BrokenAssert);
}

TEST_F(AiMisuse, OfTheRarestColourWithoutAColourForEachAgentOrOfTooManyIsAsserted) {
    RarestColour<float> rarest;
    std::vector<std::uint32_t> colours(3);
    EXPECT_THROW(rarest.update(grid_, 1, 0, colours), BrokenAssert);
    EXPECT_THROW(rarest.update(grid_, 1, 33, colours), BrokenAssert);
    EXPECT_THROW(rarest.update(grid_, 1, 2, {}), BrokenAssert);
}

TEST_F(AiMisuse, OfTheRarestColourByItsFilterOrChangesIsAsserted) {
    RarestColour<float> rarest;
    std::vector<std::uint32_t> colours(3);
    std::vector<ProxyId> agents;
    grid_.forEach([&](ProxyId id, const Aabb<float>& /*box*/) { agents.push_back(id); });
    const auto updates = [&](ProxyId) {
        ++calls_;
        EXPECT_THROW(rarest.update(grid_, 9, 2, colours), BrokenAssert);
        EXPECT_THROW(rarest.updateSome(grid_, 9, 2, colours, agents), BrokenAssert);
        return true;
    };
    rarest.update(grid_, 9, 2, colours, updates);
    EXPECT_GE(calls_, 3) << "filter";
    calls_ = 0;
    rarest.update(grid_, 9, 2, colours, acceptAll, updates);
    EXPECT_EQ(calls_, 3) << "changes";
    calls_ = 0;
    rarest.updateSome(grid_, 9, 2, colours, agents, updates);
    EXPECT_GE(calls_, 3) << "filter of some";
}

TEST_F(AiMisuse, OfSightByItsFilterOrForWhoDidNotLookIsAsserted) {
    Sight<float> sight;
    EXPECT_THROW(static_cast<void>(sight.seenBy(0)), BrokenAssert);
    const std::vector<Viewer<float>> viewers(
        2, {.eye = {0, 0, 5}, .direction = {0, 0, -1}, .range = 50, .halfAngle = 1});
    const auto filter = [&](ProxyId) {
        ++calls_;
        EXPECT_THROW(sight.look(grid_, viewers), BrokenAssert);
        return true;
    };
    sight.look(grid_, viewers, filter);
    EXPECT_GE(calls_, 6);
    EXPECT_FALSE(sight.seenBy(1).empty());
    sight.look(Grid<float>(), std::vector<Viewer<float>>(1));
    EXPECT_TRUE(sight.seenBy(0).empty());
    EXPECT_THROW(static_cast<void>(sight.seenBy(1)), BrokenAssert);
}

#endif

TEST(ZonesMisuse, OfWhatWasRemovedChangesNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    Zones<float> zones;
    const ZoneId first = zones.add({SphereRegion<float>({0, 0, 0}, 1)});
    const ZoneId removed = zones.add({SphereRegion<float>({5, 0, 0}, 1)});
    zones.remove(removed);
    for (const ZoneId id : {removed, ZoneId{}, ZoneId{99, 1}}) {
        zones.set(id, {SphereRegion<float>({9, 0, 0}, 1)});
        zones.remove(id);
        EXPECT_TRUE(zones.occupants(id).empty());
        static_cast<void>(zones.zone(id));
    }
    std::vector<ZoneId> found;
    zones.zonesAt({0, 0, 0}, found);
    EXPECT_EQ(found, std::vector{first});
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 9 : 0);
}

TEST(ZonesMisuse, OfForgetOccupantsByAFilterIsAsserted) {
    const CaughtAsserts caught;
    Grid<float> grid;
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1)));
    Zones<float> zones;
    static_cast<void>(zones.add({SphereRegion<float>({0, 0, 0}, 9)}));
    const auto filter = [&](ZoneId, ProxyId) {
        zones.forgetOccupants();
        return true;
    };
    static_cast<void>(zones.update(grid, filter));
    EXPECT_EQ(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 1 : 0);
}

TEST(RarestColourMisuse, OfItsUpdatesByTheirCallbacksChangesNothingWithoutAssertions) {
    const CaughtAsserts caught;
    Grid<float> grid;
    std::vector<ProxyId> agents;
    for (int i = 0; i < 3; ++i) {
        agents.push_back(grid.add(makeBox<float>(i, 0, 0, i + 1, 1, 1)));
    }
    RarestColour<float> rarest;
    const std::vector<std::uint32_t> zeros(3);
    const auto updates = [&](ProxyId) {
        std::vector<std::uint32_t> others = zeros;
        rarest.update(grid, 9, 32, others);
        rarest.updateSome(grid, 9, 32, others, agents);
        EXPECT_EQ(others, zeros);
        return true;
    };
    const std::vector<std::uint32_t> ones(3, 1);
    std::vector<std::uint32_t> colours = zeros;
    rarest.update(grid, 9, 2, colours, acceptAll, updates);
    EXPECT_EQ(colours, ones);
    colours = zeros;
    rarest.updateSome(grid, 9, 2, colours, agents, updates);
    EXPECT_EQ(colours, ones);
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 6 : 0);
}

}  // namespace
}  // namespace hashphase::test
