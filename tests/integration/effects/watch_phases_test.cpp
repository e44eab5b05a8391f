// SPDX-License-Identifier: Zlib

#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::test {
namespace {

TEST(WatchPhases, NamesEachPhaseInItsOrder) {
    Simulation<float> simulation(declared(
        {Effect::motion, Effect::pairs, Effect::response, Effect::culling, Effect::proximity}));
    simulation.add({});
    std::vector<std::string> names;
    simulation.watchPhases([&names](std::string_view name) { names.emplace_back(name); });
    simulation.advance(kStep);
    EXPECT_EQ(names, (std::vector<std::string>{"move and file", "pair", "gather", "respond",
                                               "culling", "proximity", "observe"}));
    simulation.watchPhases(nullptr);
    simulation.advance(kStep);
    EXPECT_EQ(names.size(), 7U);
}

TEST(WatchPhases, MayBeReplacedFromWithinAndStopsAtOnce) {
    Simulation<float> simulation(
        declared({Effect::motion, Effect::pairs, Effect::culling, Effect::proximity}));
    simulation.add({});
    // One that notes its names, and of which nothing is left once it is destroyed.
    const auto names = std::make_shared<std::vector<std::string>>();
    const auto watchUntil = [&](std::string_view last, const auto& stop) {
        names->clear();
        simulation.watchPhases([kept = names, last, stop](std::string_view name) {
            if (name == last) {
                stop();
                EXPECT_GT(kept.use_count(), 1) << "the function was destroyed while it ran";
            }
            kept->emplace_back(name);
        });
        simulation.advance(kStep);
    };
    watchUntil("pair", [&] { simulation.watchPhases({}); });
    EXPECT_EQ(*names, (std::vector<std::string>{"move and file", "pair"}));
    EXPECT_EQ(names.use_count(), 1);
    watchUntil("culling", [&] { simulation.watchPhases({}); });
    EXPECT_EQ(*names, (std::vector<std::string>{"move and file", "pair", "culling"}));
    EXPECT_EQ(names.use_count(), 1);

    std::vector<std::string> later;
    watchUntil("pair", [&] {
        simulation.watchPhases([&later](std::string_view name) { later.emplace_back(name); });
    });
    EXPECT_EQ(*names, (std::vector<std::string>{"move and file", "pair"}));
    EXPECT_EQ(later, (std::vector<std::string>{"culling", "proximity", "observe"}));
}

/// Counts the calls of two watches, of which the second one replaces the first one.
struct ReplacedWatch {
    ReplacedWatch() {
        simulation.add({});
        simulation.watchPhases([this](std::string_view /*phase*/) { ++callsBefore; });
    }
    // A watch too large to be kept without memory.
    void replace() {
        simulation.watchPhases([this, large = std::array<std::size_t, 16>{}](
                                   std::string_view /*phase*/) { callsAfter += large[0] + 1; });
    }

    Simulation<float> simulation{declared({Effect::motion, Effect::culling})};
    std::size_t callsBefore = 0;
    std::size_t callsAfter = 0;
};

TEST(WatchPhases, IsReplacedWhollyOrNotIfMemoryRunsOut) {
    std::size_t replaced = 0;
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<ReplacedWatch>(); },
                       [](ReplacedWatch& watch) { watch.replace(); },
                       [&](ReplacedWatch& watch, std::size_t) {
                           watch.simulation.advance(kStep);
                           EXPECT_GE(watch.callsBefore + watch.callsAfter, 3U);
                           EXPECT_TRUE(watch.callsBefore == 0 || watch.callsAfter == 0);
                           replaced += watch.callsAfter > 0 ? 1 : 0;
                       });
    EXPECT_EQ(replaced, 1U);
    EXPECT_GE(failures, kCountsAllocations ? 3U : 0U);
}

// Bodies wake and fall asleep within frames: a pick there must not list anew who moves.
TEST(WatchPhases, MayPickWithoutChangingTheFrame) {
    Simulation<float> simulation(smallSceneEffects(kSimulated));
    Simulation<float> picked(smallSceneEffects(kSimulated));
    std::vector<BodyId> bodies;
    for (Simulation<float>* each : {&simulation, &picked}) {
        fill(*each);
        bodies.clear();
        for (int i = 0; i < 30; ++i) {
            const float x = 0.6F * static_cast<float>(i);
            bodies.push_back(each->add({.position = {x, 2, 10}, .isAsleep = i % 2 == 0}));
        }
    }
    picked.watchPhases([&](std::string_view /*phase*/) {
        static_cast<void>(picked.pick(RayRegion<float>({0, 2, 10}, {20, 2, 10})));
    });
    int wakings = 0;
    for (int frame = 0; frame < 300; ++frame) {
        simulation.advance(kStep);
        picked.advance(kStep);
        wakings += static_cast<int>(simulation.cost()[SceneCounter::wokeUp]);
        for (const BodyId body : bodies) {
            ASSERT_EQ(picked.position(body), simulation.position(body)) << "in frame " << frame;
            ASSERT_EQ(picked.isAsleep(body), simulation.isAsleep(body)) << "in frame " << frame;
        }
    }
    EXPECT_GT(wakings, 10);
}

// In the frame in which it comes, and in the one after it.
TEST(WatchPhases, MaySetTheInterestOfTheNextFrame) {
    SceneEffects effects = declared({Effect::motion, Effect::sleeping});
    effects.sleeping->interestRadius = 5;
    Simulation<float> simulation(effects);
    const BodyId here = simulation.add({.position = {0, 0, 0}, .velocity = {0, 0, 9}});
    const BodyId there = simulation.add({.position = {100, 0, 0}, .velocity = {0, 0, 9}});
    simulation.observers().setInterest(Vector3<float>(0, 0, 0));
    simulation.advance(kStep);
    EXPECT_TRUE(simulation.isAsleep(there));
    simulation.watchPhases([&](std::string_view phase) {
        if (phase == "wake") {
            simulation.observers().setInterest(Vector3<float>(100, 0, 0));
        }
    });
    simulation.advance(kStep);
    simulation.watchPhases({});
    simulation.advance(kStep);
    EXPECT_FALSE(simulation.isAsleep(there));
    EXPECT_TRUE(simulation.isAsleep(here));
}

/// What is done in a watch after each phase, and whether that was asserted.
class MisusingWatch : public testing::Test {
protected:
    template <class Watched, class Misuse>
    void watch(Watched& watched, const Misuse& misuse) {
        watched.watchPhases([this, misuse](std::string_view /*phase*/) {
            ++calls_;
            misuse();
        });
    }
    void expectThatAllWereAsserted(int times) const {
        EXPECT_EQ(caught_.count(), HASHPHASE_ENABLE_ASSERTS ? times : 0);
    }

    const CaughtAsserts caught_;
    const SceneEffects effects_ =
        declared({Effect::motion, Effect::culling, Effect::proximity, Effect::radar});
    int calls_ = 0;
};

TEST_F(MisusingWatch, OfASimulationIsAssertedAndChangesNothing) {
    Simulation<float> simulation(effects_);
    const BodyId body = simulation.add({.velocity = {1, 0, 0}});
    watch(simulation, [&] {
        simulation.declare({});
        simulation.advance(kStep);
    });
    simulation.advance(kStep);
    EXPECT_EQ(calls_, 6);  // the bodies move, the grid, three that observe, and these together
    expectThatAllWereAsserted(2 * calls_);
    EXPECT_EQ(simulation.declared().set(), effects_.set());
    EXPECT_EQ(simulation.position(body).x(), kStep);
    simulation.watchPhases({});
    simulation.declare({});
    EXPECT_EQ(simulation.declared().set(), EffectSet{});
}

TEST_F(MisusingWatch, OfBodiesIsAsserted) {
    Simulation<float> simulation(effects_);
    std::vector<BodyId> bodies(20);
    std::generate(bodies.begin(), bodies.end(), [&] { return simulation.add({}); });
    watch(simulation, [&] {
        simulation.remove(bodies.back());
        bodies.pop_back();
        simulation.setPosition(bodies.back(), {1, 2, 3});
        simulation.setVelocity(bodies.back(), {1, 2, 3});
        simulation.collide(bodies[0], bodies[1]);
        static_cast<void>(simulation.add({}));
    });
    simulation.advance(kStep);
    EXPECT_EQ(calls_, 6);
    if (HASHPHASE_ENABLE_ASSERTS) {
        EXPECT_GE(caught_.count(), 5 * calls_);
    }
    EXPECT_EQ(simulation.size(), 20U);
    simulation.watchPhases({});
    simulation.advance(kStep);
    EXPECT_EQ(simulation.validate(), "");
}

TEST_F(MisusingWatch, OfObserversIsAssertedAndChangesNothing) {
    Observers<float> observers(effects_);
    Grid<float> grid;
    static_cast<void>(grid.add(Aabb<float>(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1))));
    watch(observers, [&] {
        observers.declare({});
        observers.observe({grid});
    });
    observers.observe({grid});
    EXPECT_EQ(calls_, 3);
    expectThatAllWereAsserted(2 * calls_);
    EXPECT_EQ(observers.declared().set(), effects_.set());
    observers.watchPhases({});
    observers.declare({});
    EXPECT_EQ(observers.declared().set(), EffectSet{});
}

}  // namespace
}  // namespace hashphase::test
