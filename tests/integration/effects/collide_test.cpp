// SPDX-License-Identifier: Zlib

#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::test {
namespace {

/// Bodies close together, of which some do not move and some are sensors.
std::vector<BodyId> addThrong(Simulation<float>& simulation) {
    Random random(7);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 200; ++i) {
        Body<float> body;
        body.position = random.pointIn(0, 14).cast<float>();
        body.velocity = random.pointIn(-5, 5).cast<float>();
        if (i % 10 == 3) {
            body.effects.erase(Effect::motion);
        }
        if (i % 10 == 7) {
            body.effects.erase(Effect::response);
        }
        bodies.push_back(simulation.add(body));
    }
    return bodies;
}

SceneEffects throngEffects(EffectSet effects) {
    SceneEffects all = declared(effects);
    all.motion->bounds = {Vector3<double>::Zero(), Vector3<double>::Constant(14)};
    return all;
}

TEST(Collide, MovesBodiesAsTheFrameDoesWithPairsFoundElsewhere) {
    SceneEffects effects = throngEffects({Effect::motion, Effect::pairs, Effect::response});
    effects.response->restitution = 0.75;
    Simulation<float> own(effects);
    Simulation<float> other(throngEffects({Effect::motion}));
    const std::vector<BodyId> bodies = addThrong(own);
    ASSERT_EQ(addThrong(other), bodies);
    int collisions = 0;
    for (int frame = 0; frame < 60; ++frame) {
        own.advance(kStep);
        other.advance(kStep);
        for (std::size_t a = 0; a < bodies.size(); ++a) {
            for (std::size_t b = a + 1; b < bodies.size(); ++b) {
                // In any order of the two.
                collisions += other.collide(bodies[b], bodies[a], 0.75) ? 1 : 0;
            }
        }
        for (const BodyId body : bodies) {
            ASSERT_EQ(own.position(body), other.position(body)) << "frame " << frame;
            ASSERT_EQ(own.velocity(body), other.velocity(body)) << "frame " << frame;
        }
    }
    EXPECT_GT(collisions, 400);
}

TEST(Collide, WakesWhoIsHit) {
    SceneEffects effects = declared({Effect::motion, Effect::sleeping});
    Simulation<float> simulation(effects);
    const BodyId ball = simulation.add({.velocity = {1, 0, 0}});
    const BodyId sleeper = simulation.add({.position = {1.5F, 0, 0}, .isAsleep = true});
    EXPECT_TRUE(simulation.collide(ball, sleeper));
    EXPECT_FALSE(simulation.isAsleep(sleeper));
    EXPECT_EQ(simulation.velocity(sleeper), Vector3<float>(1, 0, 0));
    EXPECT_EQ(simulation.advance(kStep)[SceneCounter::wokeUp], 1U);
}

TEST(Collide, RefusesABodyWithItself) {
    const ThrowingAsserts asserts;
    Simulation<float> simulation(declared({Effect::motion}));
    const BodyId body = simulation.add({});
    EXPECT_THROW(simulation.collide(body, body), BrokenAssert);
}

TEST(Collide, NeedsMotion) {
    Simulation<float> simulation(declared({Effect::pairs}));
    const BodyId a = simulation.add({});
    const BodyId b = simulation.add({});
    EXPECT_THROW(simulation.collide(a, b), UndeclaredEffect);
}

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

/// Declares nothing any more after each phase, and notes whether that was asserted.
class DeclaringWatch : public testing::Test {
protected:
    template <class Declarer>
    void watch(Declarer& declarer) {
        declarer.watchPhases([this, &declarer](std::string_view /*phase*/) {
            ++calls_;
            declarer.declare({});
        });
    }

    const CaughtAsserts caught_;
    const SceneEffects effects_ =
        declared({Effect::motion, Effect::culling, Effect::proximity, Effect::radar});
    int calls_ = 0;
};

TEST_F(DeclaringWatch, OfASimulationIsAssertedAndChangesNothing) {
    Simulation<float> simulation(effects_);
    simulation.add({});
    watch(simulation);
    simulation.advance(kStep);
    EXPECT_EQ(calls_, 6);  // the bodies move, the grid, three that observe, and these together
    EXPECT_EQ(caught_.count(), HASHPHASE_ENABLE_ASSERTS ? calls_ : 0);
    EXPECT_EQ(simulation.declared().set(), effects_.set());
    simulation.watchPhases({});
    simulation.declare({});
    EXPECT_EQ(simulation.declared().set(), EffectSet{});
}

TEST_F(DeclaringWatch, OfObserversIsAssertedAndChangesNothing) {
    Observers<float> observers(effects_);
    Grid<float> grid;
    static_cast<void>(grid.add(Aabb<float>(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1))));
    watch(observers);
    observers.observe({grid});
    EXPECT_EQ(calls_, 3);
    EXPECT_EQ(caught_.count(), HASHPHASE_ENABLE_ASSERTS ? calls_ : 0);
    EXPECT_EQ(observers.declared().set(), effects_.set());
    observers.watchPhases({});
    observers.declare({});
    EXPECT_EQ(observers.declared().set(), EffectSet{});
}

}  // namespace
}  // namespace hashphase::test
