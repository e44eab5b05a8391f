// SPDX-License-Identifier: Zlib
//
// Simulations that are declared anew, on threads, and used wrongly.

#include <integration/effects/simulation.hpp>
#include <tests/integration/effects/small_scene.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

using Point = Vector3<float>;

// --- Changes -------------------------------------------------------------------------------------

TEST(Simulation, KeepsItsProxiesWhenPairsAndSweepComeAndGo) {
    SceneEffects effects = declared({Effect::motion, Effect::zones, Effect::picking});
    Simulation<float> simulation(effects);
    const ZoneId zone = simulation.observers().zones().add({SphereRegion<float>({0, 0, 0}, 9)});
    simulation.add({.position = {0, 0, 0}});
    simulation.add({.position = {1, 0, 0}});
    const RayRegion<float> ray({-9, 0, 0}, {9, 0, 0});
    simulation.advance(kStep);
    const ProxyId hit = simulation.pick(ray).id;
    EXPECT_EQ(simulation.observers().zones().occupants(zone).size(), 2U);
    struct Round {
        bool arePairs;
        bool doesSweep;
        std::size_t births;
    };
    for (const auto& [arePairs, doesSweep, births] :
         std::initializer_list<Round>{{true, false, 1},
                                      {false, false, 0},
                                      {true, false, 1},
                                      {true, true, 0},
                                      {true, false, 0}}) {
        effects.pairs = arePairs ? std::optional(PairsEffect()) : std::nullopt;
        effects.sweep = doesSweep ? std::optional(SweepEffect()) : std::nullopt;
        simulation.declare(effects);
        simulation.advance(kStep);
        EXPECT_EQ(simulation.pick(ray).id, hit);
        EXPECT_TRUE(simulation.observers().zoneEvents().entered.empty());
        EXPECT_EQ(simulation.observers().zoneEvents().stayed.size(), 2U);
        if (arePairs) {
            EXPECT_EQ(simulation.pairChanges().born.size(), births);
            EXPECT_TRUE(simulation.pairChanges().died.empty());
            EXPECT_EQ(simulation.pairCount(), 1U);
        }
    }
}

TEST(Simulation, LooksForPairsWhileSomebodyTakesPart) {
    Simulation<float> simulation(declared({Effect::motion, Effect::pairs, Effect::culling}));
    const auto looks = [&] {
        const std::vector<std::string_view> phases = simulation.phases();
        return std::find(phases.begin(), phases.end(), "pair") != phases.end();
    };
    const EffectSet others = EffectSet::all() - EffectSet{Effect::pairs};
    simulation.add({.effects = others});
    simulation.advance(kStep);
    EXPECT_FALSE(looks());
    const BodyId a = simulation.add({});
    const BodyId b = simulation.add({});
    simulation.advance(kStep);
    EXPECT_TRUE(looks());
    EXPECT_EQ(simulation.pairChanges().born.size(), 1U);
    simulation.remove(a);
    simulation.remove(b);
    simulation.advance(kStep);
    EXPECT_EQ(simulation.pairChanges().died.size(), 1U);
    simulation.advance(kStep);
    EXPECT_FALSE(looks());
    EXPECT_TRUE(simulation.pairChanges().died.empty());
    EXPECT_EQ(simulation.validate(), "");
}

TEST(Simulation, KeepsContactsFromWhenTheFirstThatRespondsHasCome) {
    Simulation<float> simulation(declared({Effect::motion, Effect::pairs, Effect::response}));
    const EffectSet sensor{Effect::motion, Effect::pairs};
    simulation.add({.effects = sensor});
    simulation.add({.position = {1, 0, 0}, .effects = sensor});
    simulation.advance(kStep);
    EXPECT_EQ(simulation.pairChanges().born.size(), 1U);
    EXPECT_EQ(simulation.cost()[SceneCounter::contactsTested], 0U);
    const BodyId a = simulation.add({.position = {10, 0, 0}, .velocity = {1, 0, 0}});
    const BodyId b = simulation.add({.position = {11.5F, 0, 0}, .velocity = {-1, 0, 0}});
    simulation.advance(0);
    EXPECT_EQ(simulation.pairChanges().born.size(), 1U);
    EXPECT_EQ(simulation.cost()[SceneCounter::contactsTested], 1U);
    EXPECT_EQ(simulation.velocity(a), Vector3<float>(-1, 0, 0));
    EXPECT_EQ(simulation.velocity(b), Vector3<float>(1, 0, 0));
    EXPECT_EQ(simulation.validate(), "");
}

TEST(Simulation, GivesTheSameOnAnyNumberOfThreads) {
    Simulation<float> one(smallSceneEffects(kSimulated));
    Simulation<float> many(smallSceneEffects(kSimulated));
    fill(one, 3000);
    fill(many, 3000);
    ThreadedFor threads(4, 0x5eed0fee);
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_EQ(one.advance(kStep), many.advance(kStep, threads));
    }
    for (std::uint32_t body = 0; body < 3000; ++body) {
        ASSERT_EQ(one.position({body, 1}), many.position({body, 1})) << body;
    }
}

// --- Misuse --------------------------------------------------------------------------------------

template <class Call>
std::string undeclared(const Call& call) {
    try {
        call();
    } catch (const UndeclaredEffect& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(SimulationMisuse, NamesWhatIsToBeDeclared) {
    Simulation<float> simulation;
    const BodyId body = simulation.add({});
    std::vector<ProxyId> selected;
    EXPECT_EQ(
        undeclared([&] { static_cast<void>(simulation.velocity(body)); }),
        "velocity() needs motion, which the scene does not declare. Set SceneEffects::motion.");
    EXPECT_EQ(undeclared([&] {
                  static_cast<void>(simulation.pick({{0, 0, 0}, {1, 1, 1}}));
              }),
              "pick() needs picking, which the scene does not declare. Set SceneEffects::picking.");
    EXPECT_EQ(undeclared([&] { static_cast<void>(simulation.grid()); }),
              "grid() needs one of these effects, but the scene declares none. Set one in "
              "SceneEffects: pairs, picking, boxSelection, culling, proximity, zones, radar.");
    const Observers<float>& observers = simulation.observers();
    const std::vector<std::function<void()>> others{
        [&] {
            simulation.setVelocity(body, {1, 0, 0});
        },
        [&] { static_cast<void>(simulation.isAsleep(body)); },
        [&] { static_cast<void>(simulation.ground()); },
        [&] { static_cast<void>(simulation.pairChanges()); },
        [&] { static_cast<void>(simulation.pairCount()); },
        [&] {
            simulation.select(smallSceneView(), {0, 0}, {1, 1}, selected);
        },
        [&] { static_cast<void>(observers.culler()); },
        [&] { static_cast<void>(observers.colours()); },
        [&] { static_cast<void>(observers.zoneEvents()); },
        [&] { static_cast<void>(observers.radarCounts()); },
        [&] { static_cast<void>(simulation.observers().zones()); },
        [&] { simulation.observers().setColour(0, 1); }};
    for (const std::function<void()>& other : others) {
        EXPECT_THROW(other(), UndeclaredEffect);
    }
}

TEST(SimulationMisuse, LeavesToBulletWhatIsBullets) {
    try {
        Simulation<float> simulation(declared({Effect::motion, Effect::rotation}));
        ADD_FAILURE() << "nothing was thrown";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "rotation is declared, but only Bullet simulates it. Declare it for a Bullet "
                     "world, or leave it out.");
    }
}

TEST(SimulationMisuse, AssertsLivingBodiesAndOrdinarySteps) {
    if (HASHPHASE_ENABLE_ASSERTS == 0) {
        GTEST_SKIP() << "assertions are compiled out";
    }
    ThrowingAsserts asserts;
    Simulation<float> simulation(declared({Effect::motion}));
    const BodyId body = simulation.add({});
    simulation.remove(body);
    EXPECT_THROW(static_cast<void>(simulation.position(body)), BrokenAssert);
    EXPECT_THROW(simulation.advance(-1), BrokenAssert);
    EXPECT_THROW(simulation.advance(std::numeric_limits<float>::quiet_NaN()), BrokenAssert);
}

TEST(SimulationMisuse, BearsBodiesThatAreNowhere) {
    const CaughtMessages messages;
    Simulation<float> simulation(smallSceneEffects(kSimulated));
    fill(simulation);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    simulation.add({.position = {nan, 0, 0}, .velocity = {1, 0, 0}});
    simulation.add({.position = {5, 1, 5}, .velocity = {nan, infinity, 0}});
    simulation.add({.position = {infinity, 1, 5}, .radius = -1});
    simulation.add({.position = {5, 1, 5}, .radius = nan});
    run(simulation, 5);
    EXPECT_EQ(simulation.size(), 44U);
    EXPECT_EQ(simulation.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
