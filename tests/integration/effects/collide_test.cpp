// SPDX-License-Identifier: Zlib

#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hashphase::test
