// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation, and then is there again: nothing is torn, and no event is lost.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

namespace hashphase::test {
namespace {

class OutOfMemory : public testing::Test {
protected:
    void SetUp() override {
        if (!kCountsAllocations) {
            GTEST_SKIP() << "this program has another `new`";
        }
    }
};

/// 60 boxes along x.
struct RowOfBoxes {
    RowOfBoxes() {
        for (int i = 0; i < 60; ++i) {
            ids.push_back(grid.add(boxAround<float>({double(i), 0, 0}, {1, 1, 1})));
        }
    }
    Grid<float> grid;
    std::vector<ProxyId> ids;
};

// --- What is asked again is answered as if memory had not run out ---------------------------------

struct AskedWhoIsNear : RowOfBoxes {
    static constexpr std::size_t kLeastFailures = 12;
    void ask() {
        findWithin(grid, {30, 0, 0}, 9, within);
        estimateWithin(grid, {30, 0, 0}, 9, estimated);
        findNearest(grid, {30, 0, 0}, 20, 100, nearest);
    }
    [[nodiscard]] auto answer() const { return std::tie(within, estimated, nearest); }
    std::vector<ProxyId> within;
    std::vector<ProxyId> estimated;
    std::vector<KeyedProxy<float>> nearest;
};

struct AskedRadar : RowOfBoxes {
    static constexpr std::size_t kLeastFailures = 1;
    void ask() {
        const auto counted =
            radar.scan(grid, {.columns = 9, .rows = 9}, 3, [](ProxyId id) { return id.index % 3; });
        const WorkingAllocations working;
        counts.assign(counted.begin(), counted.end());
    }
    [[nodiscard]] const auto& answer() const { return counts; }
    Radar<float> radar;
    std::vector<std::uint32_t> counts;
};

// Nobody has seen anybody until the look is repeated.
struct AskedSight : RowOfBoxes {
    static constexpr std::size_t kLeastFailures = 10;
    void ask() { sight.look(grid, viewers); }
    [[nodiscard]] auto answer() const {
        std::vector<std::size_t> counts;
        for (std::size_t i = 0; i < viewers.size(); ++i) {
            counts.push_back(sight.seenBy(i).size());
        }
        return counts;
    }
    std::vector<Viewer<float>> viewers =
        std::vector<Viewer<float>>(30, {.eye = {-3, 0, 0}, .direction = {1, 0, 0}, .range = 9});
    Sight<float> sight;
};

// All have changed or none.
struct AskedRarestColour : RowOfBoxes {
    static constexpr std::size_t kLeastFailures = 10;
    AskedRarestColour() {
        for (std::uint32_t i = 0; i < 60; ++i) {
            before.push_back(i * i % 5);
        }
        colours = before;
    }
    void ask() {
        if (colours == before) {
            rarest.update(grid, 7, 5, colours);
        }
    }
    [[nodiscard]] const auto& answer() const { return colours; }
    RarestColour<float> rarest;
    std::vector<std::uint32_t> before;
    std::vector<std::uint32_t> colours;
};

// A set that was not found to its end is not kept.
struct AskedCuller {
    static constexpr std::size_t kLeastFailures = 2;
    AskedCuller() {
        for (int i = 0; i < 2000; ++i) {
            static_cast<void>(grid.add(boxAround<float>(random.pointIn(-9, 9), {1, 1, 1})));
        }
        grid.update();
    }
    void ask() { culler.look(grid, ConvexRegion<float>({}), 0); }
    [[nodiscard]] std::size_t answer() const { return culler.count(); }
    Random random{1};
    Grid<float> grid;
    Culler<float> culler{1};
};

struct AskedPicking {
    static constexpr std::size_t kLeastFailures = 10;
    AskedPicking() {
        for (int i = 0; i < 200; ++i) {
            static_cast<void>(grid.add(boxAround<float>(random.pointIn(-9, 9), {2, 2, 2})));
        }
    }
    void ask() {
        const Camera<float> view(cameraMatrix<float>({}, {-40, 20, 0}, {0, 0, 0}),
                                 DepthRange::zeroToOne, kViewport);
        const Pixel middle = middleOf(kViewport);
        const RayRegion<float> ray = view.rayThrough(middle);
        nearest = pickNearest(grid, ray).id;
        pickAll(grid, ray, all);
        pickAll(grid, ray, tested, [](ProxyId, const RayRegion<float>&, float limit) {
            return std::optional<float>(limit);
        });
        select(grid, view, middle, middle + Pixel(90, 90), selected);
    }
    [[nodiscard]] auto answer() const {
        std::vector<ProxyId> picked;
        for (const Picked<float>& each : all) {
            picked.push_back(each.id);
        }
        return std::tuple(nearest, picked, tested.size(), selected);
    }
    Random random{1};
    Grid<float> grid;
    ProxyId nearest;
    std::vector<Picked<float>> all;
    std::vector<Picked<float>> tested;
    std::vector<ProxyId> selected;
};

template <class Asked>
class AskedOutOfMemory : public OutOfMemory {};

using AllAsked = testing::Types<AskedWhoIsNear, AskedRadar, AskedSight, AskedRarestColour,
                                AskedCuller, AskedPicking>;
TYPED_TEST_SUITE(AskedOutOfMemory, AllAsked);

TYPED_TEST(AskedOutOfMemory, IsTheSameWhenAskedAgain) {
    EXPECT_GE(askOutOfMemory<TypeParam>(), TypeParam::kLeastFailures);
}

// --- Zones ---------------------------------------------------------------------------------------

/// Zones over a grid, and who is in them by their events.
struct Watched : RowOfBoxes {
    Watched() {
        for (int i = 0; i < 4; ++i) {
            addZone();
        }
    }
    void addZone() {
        const ZoneId id = zones.add({SphereRegion<float>({float(5 * zoneIds.size()), 0, 0}, 6)});
        const WorkingAllocations working;
        zoneIds.push_back(id);
    }
    void removeZone() {
        zones.remove(zoneIds.back());
        zoneIds.pop_back();
    }
    void update() {
        const ZoneEvents events = zones.update(grid);
        const WorkingAllocations working;
        for (const ZoneEvent& event : events.left) {
            EXPECT_EQ(inside.erase(event), 1U) << "leaves but was not in";
        }
        for (const ZoneEvent& event : events.entered) {
            EXPECT_TRUE(inside.insert(event).second) << "enters but was in";
        }
    }
    void check() {
        update();
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

    Zones<float> zones;
    std::vector<ZoneId> zoneIds;
    std::set<ZoneEvent> inside;
};

TEST_F(OutOfMemory, LosesNoEventOfZonesAndTellsNoneTwice) {
    const auto check = [](Watched& watched, std::size_t) {
        watched.check();
        watched.addZone();
        watched.zones.remove(watched.zoneIds.front());
        watched.zoneIds.erase(watched.zoneIds.begin());
        watched.check();
    };
    const auto update = [](Watched& watched) { watched.update(); };
    const auto change = [](Watched& watched) {
        for (int i = 0; i < 18; ++i) {
            i < 9 ? watched.addZone() : watched.removeZone();
        }
    };
    const auto later = [] {
        auto watched = std::make_unique<Watched>();
        watched->check();
        for (const ProxyId id : watched->ids) {
            watched->grid.move(id, boxAround<float>({double(id.index) / 2, 0, 0}, {1, 1, 1}));
        }
        watched->removeZone();
        return watched;
    };
    EXPECT_GE(runOutOfMemory([] { return std::make_unique<Watched>(); }, update, check), 10U);
    EXPECT_GE(runOutOfMemory(later, update, check), 3U);
    EXPECT_GE(runOutOfMemory(later, change, check), 2U);
}

// --- The ground ----------------------------------------------------------------------------------

struct Growing {
    Growing() { terrain.add(mesh.corners()); }
    Random random{0x5eed2402};
    Mesh<float> mesh = roughGround<float>(random, 8, 1, 1, 0.1);
    Grid<float> grid;
    Terrain<float> terrain{grid};
};

TEST_F(OutOfMemory, AddsAllTrianglesOrNone) {
    for (const bool hasBad : {false, true}) {
        const std::size_t failures = runOutOfMemory(
            [=] {
                auto growing = std::make_unique<Growing>();
                if (hasBad) {
                    growing->mesh.indices[60] = 12345;
                }
                return growing;
            },
            [](Growing& growing) { addTo(growing.terrain, growing.mesh); },
            [](Growing& growing, std::size_t) {
                const std::uint32_t before = growing.terrain.size();
                EXPECT_TRUE(before == 128 || before == 256);
                EXPECT_TRUE(growing.grid.size() == before || growing.grid.size() == before - 1);
                EXPECT_EQ(growing.grid.validate(), "");
                addTo(growing.terrain, growing.mesh);
                EXPECT_EQ(growing.terrain.size(), before + 128);
                EXPECT_TRUE(growing.terrain.surfaceBelow({4, 9, 4}).has_value());
                growing.terrain.clear();
                EXPECT_EQ(growing.grid.size(), 0U);
            });
        EXPECT_GE(failures, 3U);
    }
}

// --- Simulations ---------------------------------------------------------------------------------

using Simulated = Simulation<float>;

void expectValidAfter(int frames, Simulated& simulation) {
    for (int i = 0; i < frames; ++i) {
        simulation.advance(kStep);
        EXPECT_EQ(simulation.validate(), "");
    }
}

TEST_F(OutOfMemory, AddsABodyToASimulationWhollyOrNotAtAll) {
    for (const EffectSet declared : {kSimulated, EffectSet{Effect::motion}}) {
        const std::size_t failures = runOutOfMemory(
            [&] { return std::make_unique<Simulated>(smallSceneEffects(declared)); },
            [](Simulated& simulation) {
                for (int i = 0; i < 20; ++i) {
                    simulation.add({.position = {1.5F * static_cast<float>(i), 1, 0}});
                }
            },
            [](Simulated& simulation, std::size_t) {
                const std::size_t count = simulation.size();
                simulation.add({.position = {0, 1, 5}});
                EXPECT_EQ(simulation.size(), count + 1);
                expectValidAfter(1, simulation);
            });
        EXPECT_GT(failures, 5U);
    }
}

TEST_F(OutOfMemory, LetsASimulationGoOnAfterAFrameThatFailed) {
    const std::size_t failures = runOutOfMemory(
        [] {
            auto simulation = std::make_unique<Simulated>(smallSceneEffects(kSimulated));
            fill(*simulation);
            return simulation;
        },
        [](Simulated& simulation) {
            for (int frame = 0; frame < 3; ++frame) {
                simulation.advance(kStep);
            }
        },
        [](Simulated& simulation, std::size_t) { expectValidAfter(2, simulation); });
    EXPECT_GT(failures, 20U);
}

TEST_F(OutOfMemory, LetsASimulationGoOnAfterADeclarationThatFailed) {
    const EffectSet few{Effect::motion, Effect::culling};
    const std::size_t failures = runOutOfMemory(
        [&] {
            auto simulation = std::make_unique<Simulated>(smallSceneEffects(few));
            fill(*simulation);
            simulation->advance(kStep);
            return simulation;
        },
        [](Simulated& simulation) { simulation.declare(smallSceneEffects(kSimulated)); },
        [&](Simulated& simulation, std::size_t) {
            EXPECT_EQ(simulation.observers().declared().set(), simulation.declared().set());
            if (simulation.declared().set() == few) {
                const SceneFootprint bytes = simulation.footprint();
                for (const SceneTable of : {SceneTable::sleepers, SceneTable::walkers,
                                            SceneTable::pairs, SceneTable::zones}) {
                    EXPECT_EQ(bytes[of], 0U) << "nothing has changed";
                }
            } else {
                EXPECT_EQ(simulation.declared().set(), kSimulated) << "the rest is made later";
            }
            expectValidAfter(1, simulation);
            simulation.declare(smallSceneEffects(kSimulated));
            expectValidAfter(1, simulation);
        });
    EXPECT_GT(failures, 20U);
}

}  // namespace
}  // namespace hashphase::test
