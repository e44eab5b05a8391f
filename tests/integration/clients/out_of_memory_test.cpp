// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation, and then is there again: nothing is torn, and no event is lost.

#include <integration/terrain/changed_ground.hpp>
#include <tests/integration/all_clients.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <set>
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

// Nobody has seen anybody until a look is repeated, a set that was not found to its end is not kept, and all
// colours have changed or none. Boxes are new, or have settled and moved since.
template <bool haveSettled>
struct AskedAll {
    AskedAll() {
        const auto homes = drawBoxes<float>(random, 400, cubesIn<float>(0, 40, 1));
        std::vector<ProxyId> ids;
        for (const Aabb<float>& home : homes) {
            ids.push_back(grid.add(home));
        }
        for (int frame = 0; haveSettled && frame < 20; ++frame) {
            resting = grid.update().resting;
            for (std::size_t i = 0; i < homes.size(); ++i) {
                grid.move(ids[i], shifted(random, homes[i], 0.04));
            }
        }
        EXPECT_EQ(resting, haveSettled ? 400U : 0U);
    }
    void ask() {
        if (!isAnswered) {
            culler.look(grid, ConvexRegion<float>({}), 0);
            clients.ask(grid);
            isAnswered = true;
        }
    }
    [[nodiscard]] auto answer() const { return std::pair(culler.count(), clients.answers()); }

    Random random{1};
    Grid<float> grid{GridConfig{.slack = 0.2}};
    std::size_t resting = 0;
    Culler<float> culler{1};
    bool isAnswered = false;
    AllClients<float> clients{std::vector<Vector3<float>>(30, {20, 5, 20}), 400,
                              [](ProxyId id) { return id.index % 3 != 0; },
                              [](ProxyId id) { return id.index % 50 == 0; }};
};

TEST_F(OutOfMemory, LeavesWhatIsAskedAgainTheSame) {
    EXPECT_GE(askOutOfMemory<AskedAll<false>>(), 45U);
    EXPECT_GE(askOutOfMemory<AskedAll<true>>(), 45U);
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

// Ground with refused triangles and free numbers.
struct Changing : Growing {
    Changing() {
        mesh.indices[90] = 12345;
        terrain.replace(0, mesh.vertices, mesh.indices);
        terrain.remove(40, 9);
        mesh.indices[90] = 0;
        mesh.indices[30] = 12345;
        for (int i = 0; i < 3; ++i) {
            grid.update();
        }
        static_cast<void>(grid.add(boxAround<float>({4, 1, 4}, {1, 1, 1})));
    }
    ChangedGround<float> changed{terrain};
};

template <class Change>
std::size_t runOutOfMemoryAt(const Change& change) {
    Changing whole;
    change(whole);
    const auto cornersOf = [](const Changing& changing) {
        std::vector<Vector3<float>> all;
        for (std::uint32_t i = 0; i < changing.terrain.size(); ++i) {
            const auto corners = changing.terrain.corners(i);
            all.push_back(corners[0].hasNaN() ? Vector3<float>::Zero().eval() : corners[0]);
        }
        return all;
    };
    bool isDone = false;
    return runOutOfMemory(
        [] { return std::make_unique<Changing>(); },
        [&](Changing& changing) {
            isDone = false;
            change(changing);
            isDone = true;
        },
        [&](Changing& changing, std::size_t) {
            const Changing before;
            if (!isDone) {
                EXPECT_EQ(cornersOf(changing), cornersOf(before));
                EXPECT_EQ(changing.grid.size(), before.grid.size());
                EXPECT_TRUE(
                    std::equal(changing.changed.boxes().begin(), changing.changed.boxes().end(),
                               before.changed.boxes().begin(), before.changed.boxes().end(),
                               [](const auto& a, const auto& b) { return isSameBits(a, b); }));
                change(changing);
            }
            EXPECT_EQ(cornersOf(changing), cornersOf(whole));
            EXPECT_EQ(changing.grid.size(), whole.grid.size());
            EXPECT_EQ(changing.grid.validate(), "");
            changing.terrain.clear();
            EXPECT_EQ(changing.grid.size(), 1U);
        });
}

TEST_F(OutOfMemory, ChangesAllTrianglesOrNone) {
    EXPECT_GE(runOutOfMemoryAt([](Changing& changing) {
                  const auto indices = std::span(changing.mesh.indices).first(120);
                  changing.terrain.replace(0, changing.mesh.vertices, indices);
              }),
              1U);
    EXPECT_GE(runOutOfMemoryAt([](Changing& changing) { changing.terrain.remove(60, 5); }), 1U);
    EXPECT_GE(runOutOfMemoryAt([](Changing& changing) { addTo(changing.terrain, changing.mesh); }),
              3U);
    const Vector3<float> nowhere(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    const std::array<Vector3<float>, 6> oneRefused{
        Vector3<float>(0, 0, 0), Vector3<float>(0, 0, 1), Vector3<float>(1, 0, 0), nowhere,
        Vector3<float>(0, 0, 1), Vector3<float>(1, 0, 0)};
    EXPECT_GE(runOutOfMemoryAt([&](Changing& changing) { changing.terrain.add(oneRefused); }), 1U);
    EXPECT_GE(
        runOutOfMemoryAt([&](Changing& changing) { changing.terrain.replace(0, oneRefused); }), 1U);
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
    const EffectSet few{Effect::motion};
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
