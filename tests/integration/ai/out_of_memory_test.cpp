// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation, and then is there again: nothing is torn, and no event is lost.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <tuple>
#include <vector>

namespace hashphase::test {
namespace {

/// Zones over a grid, and who is in them by their events.
struct Watched {
    explicit Watched(int zoneCount) {
        for (int i = 0; i < 60; ++i) {
            ids.push_back(grid.add(boxAround<float>({double(i), 0, 0}, {1, 1, 1})));
        }
        for (int i = 0; i < zoneCount; ++i) {
            addZone();
        }
    }
    void addZone() {
        const ZoneId id = zones.add({SphereRegion<float>({float(5 * zoneIds.size()), 0, 0}, 6)});
        const WorkingAllocations working;
        zoneIds.push_back(id);
    }
    void apply(const ZoneEvents& events) {
        const WorkingAllocations working;
        for (const ZoneEvent& event : events.left) {
            EXPECT_EQ(inside.erase(event), 1U) << "leaves but was not in";
        }
        for (const ZoneEvent& event : events.entered) {
            EXPECT_TRUE(inside.insert(event).second) << "enters but was in";
        }
    }
    void check() {
        apply(zones.update(grid));
        std::set<ZoneEvent> expected;
        for (const ZoneId zone : zoneIds) {
            const auto& ball = std::get<SphereRegion<float>>(zones.zone(zone).shape);
            for (const ProxyId id : ids) {
                const Vector3<float> at = positionOf(grid.box(id));
                if (ball.key({at, at}) >= 0) {
                    expected.insert({zone, id});
                }
            }
        }
        EXPECT_EQ(inside, expected);
        EXPECT_EQ(zones.size(), zoneIds.size());
    }

    Grid<float> grid;
    Zones<float> zones;
    std::vector<ProxyId> ids;
    std::vector<ZoneId> zoneIds;
    std::set<ZoneEvent> inside;
};

TEST(ZonesOutOfMemory, NoEventIsLostNorToldTwice) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const auto check = [](Watched& watched, std::size_t) {
        watched.check();
        watched.addZone();
        watched.zones.remove(watched.zoneIds.front());
        watched.zoneIds.erase(watched.zoneIds.begin());
        watched.check();
    };
    const auto update = [](Watched& watched) { watched.apply(watched.zones.update(watched.grid)); };
    const auto fresh = [] { return std::make_unique<Watched>(4); };
    const auto later = [] {
        auto watched = std::make_unique<Watched>(4);
        watched->check();
        for (const ProxyId id : watched->ids) {
            watched->grid.move(id, boxAround<float>({double(id.index) / 2, 0, 0}, {1, 1, 1}));
        }
        watched->zones.remove(watched->zoneIds.back());
        watched->zoneIds.pop_back();
        return watched;
    };
    const auto change = [](Watched& watched) {
        for (int i = 0; i < 9; ++i) {
            watched.addZone();
        }
        for (int i = 0; i < 9; ++i) {
            watched.zones.remove(watched.zoneIds.back());
            watched.zoneIds.pop_back();
        }
    };
    EXPECT_GE(runOutOfMemory(fresh, update, check), 10U);
    EXPECT_GE(runOutOfMemory(later, update, check), 3U);
    EXPECT_GE(runOutOfMemory(later, change, check), 2U);
}

TEST(SightOutOfMemory, NobodyHasSeenAnybodyUntilTheLookIsRepeated) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Looking {
        Watched watched{0};
        std::vector<Viewer<float>> viewers =
            std::vector<Viewer<float>>(30, {.eye = {-3, 0, 0}, .direction = {1, 0, 0}, .range = 9});
        Sight<float> sight;
    };
    const auto look = [](Looking& l) { l.sight.look(l.watched.grid, l.viewers); };
    const auto check = [&](Looking& l, std::size_t) {
        look(l);
        EXPECT_EQ(l.sight.seenBy(29).size(), l.sight.seenBy(0).size());
        EXPECT_GT(l.sight.seenBy(29).size(), 0U);
    };
    EXPECT_GE(runOutOfMemory([] { return std::make_unique<Looking>(); }, look, check), 10U);
}

TEST(ProximityOutOfMemory, IsTheSameWhenAskedAgain) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Asked {
        void ask() {
            findWithin(watched.grid, {30, 0, 0}, 9, within);
            estimateWithin(watched.grid, {30, 0, 0}, 9, estimated);
            findNearest(watched.grid, {30, 0, 0}, 20, 100, nearest);
        }
        [[nodiscard]] auto answer() const { return std::tie(within, estimated, nearest); }
        Watched watched{0};
        std::vector<ProxyId> within;
        std::vector<ProxyId> estimated;
        std::vector<KeyedProxy<float>> nearest;
    };
    EXPECT_GE(askOutOfMemory<Asked>(), 12U);
}

TEST(RadarOutOfMemory, CountsWhenAskedAgain) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Asked {
        void ask() {
            const auto counted = radar.scan(watched.grid, {.columns = 9, .rows = 9}, 3,
                                            [](ProxyId id) { return id.index % 3; });
            const WorkingAllocations working;
            counts.assign(counted.begin(), counted.end());
        }
        [[nodiscard]] const auto& answer() const { return counts; }
        Watched watched{0};
        Radar<float> radar;
        std::vector<std::uint32_t> counts;
    };
    EXPECT_GE(askOutOfMemory<Asked>(), 1U);
}

TEST(RarestColourOutOfMemory, EverybodyHasChangedOrNobody) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Asked {
        Asked() {
            for (std::uint32_t i = 0; i < 60; ++i) {
                before.push_back(i * i % 5);
            }
            colours = before;
        }
        void ask() { rarest.update(watched.grid, 7, 5, colours); }
        Watched watched{0};
        RarestColour<float> rarest;
        std::vector<std::uint32_t> before;
        std::vector<std::uint32_t> colours;
    };
    Asked whole;
    whole.ask();
    ASSERT_NE(whole.colours, whole.before);
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<Asked>(); }, [](Asked& asked) { asked.ask(); },
                       [&](Asked& asked, std::size_t) {
                           if (asked.colours == asked.before) {
                               asked.ask();
                           }
                           EXPECT_EQ(asked.colours, whole.colours);
                       });
    EXPECT_GE(failures, 10U);
}

}  // namespace
}  // namespace hashphase::test
