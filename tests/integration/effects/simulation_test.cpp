// SPDX-License-Identifier: Zlib

#include <integration/effects/simulation.hpp>
#include <integration/terrain/changed_ground.hpp>
#include <tests/integration/effects/small_scene.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace hashphase::test {
namespace {

using Point = Vector3<float>;

// --- What is counted -----------------------------------------------------------------------------

TEST(Simulation, FilesExactlyWhatMoves) {
    constexpr std::uint64_t kMoving = 17;
    Simulation<float> simulation(declared({Effect::motion, Effect::pairs, Effect::culling}));
    for (int i = 0; i < 500; ++i) {
        const bool moves = static_cast<std::uint64_t>(i) < kMoving;
        simulation.add({.position = {3.0F * static_cast<float>(i), 0, 0},
                        .velocity = {0, 60, 0},  // too fast to settle
                        .effects = moves ? EffectSet::all() : kStanding});
    }
    simulation.advance(kStep);  // all are new
    simulation.advance(kStep);  // those that stand come to rest
    for (int frame = 0; frame < 20; ++frame) {
        const SceneCost& cost = simulation.advance(kStep);
        EXPECT_EQ(cost[SceneCounter::bodiesMoved], kMoving);
        EXPECT_EQ(cost[SceneCounter::proxiesHashed], kMoving);
        EXPECT_EQ(cost[SceneCounter::entriesFiled], kMoving);
    }
}

TEST(Simulation, FilesNobodyWhileNobodyLooks) {
    Simulation<float> simulation(declared({Effect::motion, Effect::culling, Effect::zones}));
    for (int i = 0; i < 50; ++i) {
        simulation.add({.position = {3.0F * static_cast<float>(i), 0, 0},
                        .velocity = {0, 1, 0},
                        .effects = {Effect::motion}});
    }
    simulation.advance(kStep);  // all are new
    for (int frame = 0; frame < 5; ++frame) {
        const SceneCost& cost = simulation.advance(kStep);
        EXPECT_EQ(cost[SceneCounter::bodiesMoved], 50U);
        EXPECT_EQ(cost[SceneCounter::proxiesHashed], 0U);
        EXPECT_EQ(cost[SceneCounter::entriesFiled], 0U);
    }
    simulation.add({});
    // All are filed where they are, then all move.
    EXPECT_EQ(simulation.advance(kStep)[SceneCounter::proxiesHashed], 51U + 51U);
    EXPECT_EQ(simulation.validate(), "");
    EXPECT_EQ(simulation.observers().culler().count(), 1U);
}

TEST(Simulation, SweepsExactlyWhatIsFastForItsSize) {
    SceneEffects effects = declared({Effect::motion, Effect::pairs, Effect::sweep});
    effects.sweep->fastFrom = 1;
    Simulation<float> simulation(effects);
    for (int i = 0; i < 300; ++i) {
        const bool isFast = i % 30 == 0;
        simulation.add({.position = {3.0F * static_cast<float>(i), 0, 0},
                        .velocity = {0, isFast ? 2 / kStep : 1.99F / kStep, 0}});
    }
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_EQ(simulation.advance(kStep)[SceneCounter::sweepsSolved], 10U);
    }
}

TEST(Simulation, SweepsNobodyWhoDoesNotTakePart) {
    Simulation<float> simulation(declared({Effect::motion, Effect::pairs, Effect::sweep}));
    for (int i = 0; i < 30; ++i) {
        simulation.add({.position = {3.0F * static_cast<float>(i), 0, 0},
                        .velocity = {0, 1000, 0},
                        .effects = EffectSet::all() - EffectSet{Effect::sweep}});
    }
    EXPECT_EQ(simulation.advance(kStep)[SceneCounter::sweepsSolved], 0U);
}

TEST(Simulation, TouchesNothingWhileAllSleep) {
    Simulation<float> simulation(smallSceneEffects(kSimulated));
    fill(simulation, 0);
    for (int i = 0; i < 200; ++i) {
        simulation.add(
            {.position = {1.5F * static_cast<float>(i % 20), 1, 1.5F * static_cast<float>(i / 20)},
             .velocity = {5, 0, 5},
             .isAsleep = true});
    }
    const BodyId last =
        simulation.add({.position = {9, 1, 9}, .velocity = {5, 0, 5}, .isAsleep = true});
    EXPECT_TRUE(simulation.isAsleep(last));
    simulation.advance(kStep);
    for (int frame = 0; frame < 20; ++frame) {
        const SceneCost& cost = simulation.advance(kStep);
        for (const SceneCounter counter :
             {SceneCounter::bodiesMoved, SceneCounter::groundsAsked, SceneCounter::trianglesTested,
              SceneCounter::proxiesHashed, SceneCounter::entriesFiled, SceneCounter::boxesTested,
              SceneCounter::pairsWatched, SceneCounter::contactsTested, SceneCounter::sweepsSolved,
              SceneCounter::sleepersAsked, SceneCounter::cellRowsCulled}) {
            EXPECT_EQ(cost[counter], 0U)
                << sceneCounters()[static_cast<std::size_t>(counter)].name << ", frame " << frame;
        }
    }
    EXPECT_TRUE(simulation.isAsleep(last));
    EXPECT_EQ(simulation.position(last), Point(9, 1, 9));
}

// --- What bodies do ------------------------------------------------------------------------------

TEST(Simulation, TurnsBackAtItsBounds) {
    SceneEffects effects = declared({Effect::motion});
    effects.motion->bounds = {Vector3<double>(-1, -1, -1), Vector3<double>(1, 1, 1)};
    Simulation<float> simulation(effects);
    const BodyId body = simulation.add({.velocity = {1, -2, 0}});
    for (int frame = 0; frame < 640; ++frame) {
        simulation.advance(kStep);
        EXPECT_LE(simulation.position(body).cwiseAbs().maxCoeff(), 1);
    }
    EXPECT_EQ(simulation.velocity(body).cwiseAbs(), Vector3<float>(1, 2, 0));
}

TEST(Simulation, BouncesOffByTheAngleOfImpact) {
    Simulation<double> simulation(declared({Effect::motion, Effect::pairs, Effect::response}));
    const double c = std::sqrt(0.5);
    // It meets the other at 45 degrees: they part at a right angle, as billiard balls do.
    const BodyId cue = simulation.add({.position = {-2.5 - c, 0, 0}, .velocity = {4, 0, 0}});
    const BodyId ball = simulation.add({.position = {0, 0, 2 * c}});
    run(simulation, 200, 1.0 / 256);
    const Vector3<double> a = simulation.velocity(cue);
    const Vector3<double> b = simulation.velocity(ball);
    EXPECT_NEAR(a.squaredNorm() + b.squaredNorm(), 16, 1e-9);
    EXPECT_NEAR((a + b - Vector3<double>(4, 0, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR(a.dot(b), 0, 1e-9);
    EXPECT_GT(b.norm(), 1);
}

TEST(Simulation, BouncesOffWhatStands) {
    SceneEffects effects = declared({Effect::motion, Effect::pairs, Effect::response});
    effects.response->restitution = 0.5;
    Simulation<float> simulation(effects);
    const BodyId ball = simulation.add({.position = {-3, 0, 0}, .velocity = {1, 0, 0}});
    const BodyId post = simulation.add({.effects = kStanding});
    run(simulation, 128);
    EXPECT_EQ(simulation.velocity(ball), Vector3<float>(-0.5F, 0, 0));
    EXPECT_EQ(simulation.position(post), Vector3<float>(0, 0, 0));
}

TEST(Simulation, LetsSensorsFeelWithoutBouncing) {
    Simulation<float> simulation(declared({Effect::motion, Effect::pairs, Effect::response}));
    const BodyId ball = simulation.add({.position = {-3, 0, 0}, .velocity = {8, 0, 0}});
    simulation.add({.effects = EffectSet::all() - EffectSet{Effect::response}});
    const SceneCost sum = run(simulation, 64);
    EXPECT_EQ(simulation.velocity(ball), Vector3<float>(8, 0, 0));
    EXPECT_EQ(sum[SceneCounter::pairsBorn], 1U);
    EXPECT_EQ(sum[SceneCounter::pairsDied], 1U);
    EXPECT_EQ(sum[SceneCounter::contactsTested], 0U);
}

/// Whether a bullet that flies by `speed` [m/s] has come through a wall of spheres.
bool comesThrough(const SceneEffects& effects, float speed) {
    Simulation<float> simulation(effects);
    for (int i = -5; i <= 5; ++i) {
        for (int k = -5; k <= 5; ++k) {
            simulation.add(
                {.position = {0, 0.2F * static_cast<float>(i), 0.2F * static_cast<float>(k)},
                 .radius = 0.2F,
                 .effects = kStanding});
        }
    }
    const BodyId bullet = simulation.add(
        {.position = {-50.1F, 0.03F, 0.02F}, .radius = 0.05F, .velocity = {speed, 0, 0}});
    while (simulation.position(bullet).x() < 50 && simulation.velocity(bullet).x() > 0) {
        simulation.advance(kStep);
    }
    return simulation.position(bullet).x() > 0;
}

TEST(Simulation, StopsBulletsWhereTheySweepAndLosesThemWhereNot) {
    const SceneEffects without = declared({Effect::motion, Effect::pairs, Effect::response});
    SceneEffects with = without;
    for (const float speed : {300.0F, 1000.0F, 3000.0F, 30000.0F}) {
        EXPECT_TRUE(comesThrough(without, speed)) << speed;
        for (const Sweep mode : {Sweep::automatic, Sweep::box, Sweep::line}) {
            with.sweep = SweepEffect{.mode = mode};
            EXPECT_FALSE(comesThrough(with, speed)) << speed;
        }
    }
}

TEST(Simulation, StandsOnTheGround) {
    Simulation<float> simulation(declared({Effect::motion, Effect::terrain}));
    const std::vector<Point> slope{Point(0, 0, -50),    Point(100, 50, -50), Point(0, 0, 50),
                                   Point(100, 50, -50), Point(100, 50, 50),  Point(0, 0, 50)};
    simulation.ground().add(slope);
    const BodyId body = simulation.add({.position = {5, 6, 0}, .velocity = {10, 0, 0}});
    run(simulation, 500);
    const float x = simulation.position(body).x();
    // On a slope of 1 : 2 the centre is higher by radius / cos(angle).
    EXPECT_NEAR(simulation.position(body).y(), x / 2 + std::sqrt(1.25F), 1e-3F);
}

TEST(Simulation, SleepsWhereNobodyLooksAndWakesWhenSomebodyComes) {
    SceneEffects effects = declared({Effect::motion, Effect::sleeping});
    effects.sleeping->interestRadius = 10;
    Simulation<float> simulation(effects);
    const BodyId near = simulation.add({.position = {5, 0, 0}, .velocity = {0, 1, 0}});
    const BodyId far = simulation.add({.position = {50, 0, 0}, .velocity = {0, 1, 0}});
    simulation.observers().setInterest(Vector3<float>(0, 0, 0));
    EXPECT_EQ(simulation.advance(kStep)[SceneCounter::fellAsleep], 1U);
    const SceneCost& quiet = simulation.advance(kStep);
    EXPECT_EQ(quiet[SceneCounter::bodiesMoved], 1U);
    EXPECT_EQ(quiet[SceneCounter::sleepersAsked], 0U);
    EXPECT_TRUE(simulation.isAsleep(far));
    EXPECT_FALSE(simulation.isAsleep(near));
    simulation.observers().setInterest(Vector3<float>(50, 0, 0));
    const SceneCost& came = simulation.advance(kStep);
    EXPECT_EQ(came[SceneCounter::wokeUp], 1U);
    EXPECT_EQ(came[SceneCounter::fellAsleep], 1U);
    EXPECT_FALSE(simulation.isAsleep(far));
    EXPECT_EQ(simulation.velocity(far), Vector3<float>(0, 1, 0));
}

TEST(Simulation, PutsTheSlowToSleepUntilSomebodyHitsThem) {
    SceneEffects effects =
        declared({Effect::motion, Effect::pairs, Effect::response, Effect::sleeping});
    effects.sleeping->slowBelow = 0.1;
    effects.sleeping->framesBeforeSleep = 5;
    Simulation<float> simulation(effects);
    const BodyId slow = simulation.add({.velocity = {0.01F, 0, 0}});
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_FALSE(simulation.isAsleep(slow));
        simulation.advance(kStep);
    }
    EXPECT_TRUE(simulation.isAsleep(slow));
    simulation.add({.position = {-4, 0, 0}, .velocity = {8, 0, 0}});
    const SceneCost sum = run(simulation, 64);
    EXPECT_FALSE(simulation.isAsleep(slow));
    EXPECT_EQ(sum[SceneCounter::wokeUp], 1U);
    EXPECT_GT(simulation.position(slow).x(), 1);
}

TEST(Simulation, TellsWhoSleepsOnChangedGround) {
    SceneEffects effects =
        declared({Effect::motion, Effect::terrain, Effect::sleeping, Effect::picking});
    effects.sleeping->slowBelow = 0.1;
    Simulation<float> simulation(effects);
    Terrain<float>& ground = simulation.ground();
    const auto tileAt = [](float x, float y) {
        return std::array{Point(x - 9, y, -9), Point(x + 9, y, -9), Point(x, y, 9)};
    };
    const AddedTriangles left = ground.add(tileAt(-10, 0));
    ground.add(tileAt(10, 0));
    const BodyId falls = simulation.add({.position = {-10, 1, 0}});
    const BodyId stays = simulation.add({.position = {10, 1, 0}});
    ChangedGround<float> changed(ground);
    run(simulation, 60);
    ASSERT_TRUE(simulation.isAsleep(falls) && simulation.isAsleep(stays));
    ground.replace(left.first, tileAt(-10, -2));
    std::vector<ProxyId> standing;
    changed.findStanding(simulation.grid(), 0.05F, standing);
    ASSERT_EQ(standing.size(), 1U);
    EXPECT_EQ(simulation.bodyOf(standing[0]), falls);
    simulation.setPosition(falls, simulation.position(falls));
    run(simulation, 1);
    EXPECT_FALSE(simulation.isAsleep(falls));
    EXPECT_EQ(simulation.position(falls), Point(-10, -1, 0));
    EXPECT_TRUE(simulation.isAsleep(stays));
}

// --- What is easily missed -------------------------------------------------------------------------

TEST(Simulation, SeesWhoFliesIntoAViewFromTheOrigin) {
    Simulation<float> simulation(declared({Effect::motion, Effect::culling}));
    using Plane = Eigen::Hyperplane<float, 3>;
    const std::array planes{Plane(Point(1, 0, 1), 0), Plane(Point(-1, 0, 1), 0),
                            Plane(Point(0, 1, 1), 0), Plane(Point(0, -1, 1), 0)};
    simulation.observers().setView(ConvexRegion<float>(planes));
    simulation.add({.position = {0, 0, -50}, .velocity = {0, 0, 10}});
    run(simulation, 12, 1.0F);
    EXPECT_EQ(simulation.observers().culler().count(), 1U);
}

TEST(Simulation, TellsOnceThatTheLastOneHasLeft) {
    SceneEffects effects =
        declared({Effect::motion, Effect::zones, Effect::radar, Effect::culling});
    effects.zones = ZonesEffect{.interestRadius = 10, .farFrames = 4};
    effects.radar->frames = 4;
    effects.culling->restingCameraFrames = 4;
    Simulation<float> simulation(effects);
    simulation.observers().setInterest(Point(0, 0, 0));
    static_cast<void>(simulation.observers().zones().add({SphereRegion<float>({100, 0, 0}, 5)}));
    const BodyId body = simulation.add({.position = {100, 0, 0}});
    simulation.advance(kStep);
    EXPECT_EQ(simulation.observers().zoneEvents().entered.size(), 1U);
    simulation.remove(body);
    simulation.advance(kStep);
    EXPECT_EQ(simulation.observers().zoneEvents().left.size(), 1U);
    EXPECT_EQ(simulation.observers().culler().count(), 0U);
    for (const std::uint32_t count : simulation.observers().radarCounts()) {
        ASSERT_EQ(count, 0U);
    }
    simulation.advance(kStep);
    EXPECT_TRUE(simulation.observers().zoneEvents().left.empty());
}

TEST(Simulation, WakesWhoIsPutElsewhere) {
    SceneEffects effects = declared({Effect::motion, Effect::sleeping});
    effects.sleeping->interestRadius = 10;
    Simulation<float> simulation(effects);
    const BodyId body = simulation.add({.position = {50, 0, 0}, .velocity = {0, 1, 0}});
    const BodyId other = simulation.add({.position = {60, 0, 0}, .velocity = {0, 1, 0}});
    simulation.observers().setInterest(Point(0, 0, 0));
    simulation.advance(kStep);
    EXPECT_TRUE(simulation.isAsleep(body));
    simulation.setPosition(body, {1, 0, 0});
    simulation.advance(kStep);
    EXPECT_FALSE(simulation.isAsleep(body));
    EXPECT_TRUE(simulation.isAsleep(other));
    effects.sleeping->interestRadius = 100;
    simulation.declare(effects);
    simulation.advance(kStep);
    EXPECT_FALSE(simulation.isAsleep(other));
}

TEST(Simulation, HitsWhatStandsBeforeAWall) {
    SceneEffects effects =
        declared({Effect::motion, Effect::pairs, Effect::response, Effect::sweep});
    effects.motion->bounds = {Vector3<double>(-100, -100, -100), Vector3<double>(10, 100, 100)};
    Simulation<float> simulation(effects);
    const BodyId bullet = simulation.add({.radius = 0.5F, .velocity = {20, 0, 0}});
    const BodyId ball = simulation.add({.position = {5, 0, 0}, .radius = 0.5F});
    simulation.advance(1);
    EXPECT_NEAR(simulation.position(bullet).x(), 4, 1e-5F);
    EXPECT_EQ(simulation.velocity(bullet), Point(0, 0, 0));
    EXPECT_EQ(simulation.velocity(ball), Point(20, 0, 0));
}

TEST(Simulation, StandsOnTheGroundWhereItIsStopped) {
    SceneEffects effects =
        declared({Effect::motion, Effect::terrain, Effect::pairs, Effect::response, Effect::sweep});
    Simulation<float> simulation(effects);
    // A ridge: the way from one foot of it to the other leads through.
    const std::vector<Point> ridge{{-50, 0, -50}, {0, 25, -50}, {-50, 0, 50}, {0, 25, -50},
                                   {0, 25, 50},   {-50, 0, 50}, {0, 25, -50}, {50, 0, -50},
                                   {0, 25, 50},   {50, 0, -50}, {50, 0, 50},  {0, 25, 50}};
    simulation.ground().add(ridge);
    const auto onRidge = [](float x) { return 25 - std::abs(x) / 2 + std::sqrt(1.25F); };
    const BodyId bullet =
        simulation.add({.position = {-20, onRidge(-20), 0}, .velocity = {40, 0, 0}});
    // So wide that it is met at half way.
    simulation.add({.position = {10, 12, 0}, .radius = 9, .effects = kStanding});
    EXPECT_EQ(simulation.advance(1)[SceneCounter::sweepersStopped], 1U);
    const Point position = simulation.position(bullet);
    EXPECT_LT(std::abs(position.x()), 10);
    EXPECT_NEAR(position.y(), onRidge(position.x()), 1.5F);
    EXPECT_EQ(simulation.validate(), "");
}

TEST(Simulation, CountsWhatIsWokenAndMovedBetweenFrames) {
    SceneEffects effects = declared({Effect::motion, Effect::sleeping, Effect::culling});
    Simulation<float> simulation(effects);
    const BodyId body = simulation.add({.isAsleep = true});
    simulation.advance(kStep);
    simulation.setVelocity(body, {1, 0, 0});
    simulation.setPosition(body, {5, 0, 0});
    const SceneCost& cost = simulation.advance(kStep);
    EXPECT_EQ(cost[SceneCounter::wokeUp], 1U);
    EXPECT_EQ(cost[SceneCounter::proxiesHashed], 2U);
    EXPECT_EQ(simulation.advance(kStep)[SceneCounter::wokeUp], 0U);
}

TEST(Simulation, ShowsNobodyForHavingTheIndexOfOneThatWasVisible) {
    SceneEffects effects = declared({Effect::motion, Effect::culling, Effect::proximity});
    effects.culling->restingCameraFrames = 10;
    Simulation<float> simulation(effects);
    const BodyId body = simulation.add({});
    simulation.observers().setColour(body.index, 3);
    simulation.advance(kStep);
    EXPECT_EQ(simulation.observers().culler().count(), 1U);
    simulation.remove(body);
    EXPECT_EQ(simulation.observers().culler().count(), 0U);
    EXPECT_EQ(simulation.observers().colours()[body.index], 0U);
}

TEST(Simulation, KeepsASetByMarginThoughTheCameraRests) {
    SceneEffects effects = declared({Effect::motion, Effect::culling});
    effects.culling = CullingEffect{.margin = 1, .restingCameraFrames = 2};
    Simulation<float> simulation(effects);
    simulation.add({.velocity = {0.125F / kStep, 0, 0}});
    std::uint64_t found = 0;
    for (int frame = 0; frame < 33; ++frame) {
        found += simulation.advance(kStep)[SceneCounter::viewsFound];
    }
    // At first, and whenever it may have moved by more than the margin.
    EXPECT_GE(found, 4U);
    EXPECT_LE(found, 5U);
}

TEST(Simulation, UsesIndicesAgainThoughNobodyLooks) {
    Simulation<float> simulation(declared({Effect::motion, Effect::culling}));
    for (int i = 0; i < 200; ++i) {
        const BodyId body = simulation.add({.effects = {Effect::motion}});
        simulation.advance(kStep);
        simulation.remove(body);
    }
    EXPECT_LT(simulation.grid().indexLimit(), 20U);
}

}  // namespace
}  // namespace hashphase::test
