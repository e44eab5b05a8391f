// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/stage_queries.hpp>
#include <demos/viewer/stage/bullet_stage.hpp>
#include <tests/viewer/session/stages.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/effects/bullet_frame.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace hashphase::demos {
namespace {

TEST(BulletStage, KeepsIndicesAndPairsWhenTheBroadphaseIsSwapped) {
    BulletStage stage(worldNamed("pile"), 150, 1);
    EXPECT_EQ(stage.remove(std::array{0U, 7U}), 1U);  // not the floor
    for (const char* name : {"dbvt", "hash", "simple", "axis-sweep", "dbvt-deferred", "hash"}) {
        const Vector3<float> before = stage.body(100).centre;
        stage.setBroadphase(kindNamed(name));
        EXPECT_EQ(stage.body(100).centre, before);
        EXPECT_FALSE(stage.contains(7));
        for (int step = 0; step < 20; ++step) {
            stage.step();
            expectPairs(stage, stage.broadphase().ours, name);
            // Whatever the grid is, it knows bodies by their indices.
            const Picked<float> picked = stage.pick(
                {stage.body(100).centre + Vector3<float>(0, 1e-3F, 0), stage.body(100).centre});
            EXPECT_EQ(picked.id.index, 100U) << name;
        }
    }
    EXPECT_EQ(stage.size(), 150U);
}

TEST(BulletStage, TellsTheMemoryOfTheBroadphaseThatIsAtWork) {
    BulletStage stage(worldNamed("pile"), 1000, 1);
    const auto runFor = [&stage](int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            stage.step();
        }
    };
    runFor(60);
    const auto ofTheGrid = [&stage] {
        return static_cast<std::int64_t>(stage.grid()->memoryBytes());
    };
    // Proxies and pairs are more than the grid.
    constexpr std::int64_t kLeast = 1000 * sizeof(btBroadphaseProxy);
    ASSERT_TRUE(stage.memoryBytes());
    EXPECT_GT(*stage.memoryBytes(), ofTheGrid() + kLeast);
    stage.setBroadphase(kindNamed("dbvt"));
    runFor(60);
    if (heapBytes()) {
        ASSERT_TRUE(stage.memoryBytes()) << "the former broadphase's memory is not the next one's";
        EXPECT_GT(*stage.memoryBytes(), ofTheGrid() + kLeast);
    }
    stage.setBroadphase(kindNamed("hash"));
    runFor(60);
    EXPECT_GT(stage.memoryBytes(), ofTheGrid() + kLeast);
    const BulletWorld world(kindNamed("hash"), worldNamed("pile"), 100, 1);
    const auto& ours = dynamic_cast<const SpatialHashBroadphase&>(*world.broadphase);
    EXPECT_EQ(world.memoryBytes(), static_cast<std::int64_t>(ours.memoryBytes()));
}

TEST(BulletStage, FilesBodiesInCellsOfTheDeclaredSize) {
    BulletStage stage(worldNamed("pile"), 150, 1);
    for (const char* name : {"hash", "dbvt", "hash"}) {
        stage.setBroadphase(kindNamed(name));
        for (const double cellSize : {4.0, 9.0}) {
            SceneEffects effects = stage.effects();
            effects.grid.cellSize = cellSize;
            stage.declare(effects);
            EXPECT_EQ(stage.grid()->cellSize(), cellSize) << name;
            for (int step = 0; step < 3; ++step) {
                stage.step();
                expectPairs(stage, stage.broadphase().ours, name);
            }
            EXPECT_EQ(stage.grid()->cellSize(), cellSize) << name;
        }
    }
    stage.setBroadphase(kindNamed("dbvt"));
    EXPECT_EQ(stage.grid()->cellSize(), 9);
}

TEST(BulletStage, ColoursAgentsOnceWhenTheyBeginToLookAround) {
    BulletStage stage(worldNamed("stack"), 200, 1);
    SceneEffects effects = stage.effects();
    effects.declare(Effect::proximity);
    stage.declare(effects);
    expectEvenColours(stage);
    for (int frame = 0; frame < 5; ++frame) {
        stage.step();
    }
    const std::span<const std::uint32_t> now = stage.observers().colours();
    const std::vector<std::uint32_t> before(now.begin(), now.end());
    effects.proximity->radius = 3;
    stage.declare(effects);
    const std::span<const std::uint32_t> after = stage.observers().colours();
    EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin(), after.end()));
}

TEST(BulletStage, OffersNoEffectsThatItsScenesHaveNothingFor) {
    const BulletStage stage(worldNamed("pile"), 5, 1);
    EXPECT_FALSE(stage.possibleEffects().containsAny({Effect::zones, Effect::terrain}));
    EXPECT_TRUE(stage.possibleEffects().contains(Effect::radar));
}

TEST(BulletStage, HearsBulletsOwnZones) {
    BulletStage stage(worldNamed("pile"), 50, 1);
    stage.step();
    const auto zones = stage.zones();
    ASSERT_FALSE(zones.empty());
    EXPECT_EQ(zones.front().depth, 0);
    const auto isThere = [&](std::string_view name) {
        return std::any_of(zones.begin(), zones.end(),
                           [name](const ProfileZone& zone) { return zone.name == name; });
    };
    for (const char* name : {"updateAabbs", "calculateOverlappingPairs",
                             "dispatchAllCollisionPairs", "solveConstraints"}) {
        EXPECT_TRUE(isThere(name)) << name;
    }
    for (std::size_t i = 1; i < zones.size(); ++i) {
        EXPECT_LE(zones[i].depth, zones[i - 1].depth + 1);
        EXPECT_GT(zones[i].calls, 0U);
    }
}

TEST(BulletStage, MarksWhatPassesThroughWallsUnlessItIsSwept) {
    BulletStage discrete(worldNamed("bullet-storm"), 60, 1);
    BulletStage swept(worldNamed("bullet-storm"), 60, 1);
    SceneEffects effects = swept.effects();
    effects.declare(Effect::sweep);
    swept.declare(effects);
    for (int frame = 0; frame < 60; ++frame) {
        discrete.step();
        swept.step();
    }
    EXPECT_GT(discrete.tunnelMarks().size(), 60U);
    EXPECT_EQ(swept.tunnelMarks().size(), 0U);
    for (const TunnelMark& mark : discrete.tunnelMarks()) {
        EXPECT_GT((mark.to - mark.from).norm(), 1);
        EXPECT_LT((mark.to - mark.from).norm(), 7) << "was put there, and has not flown";
    }
}

TEST(BulletStage, GoesOnMarkingMissesAndShowsTheLastOnes) {
    BulletStage stage(worldNamed("bullet-storm"), 60, 1);
    const auto missesIn = [&stage](int frames) {
        const std::uint64_t before = stage.tunnelCount();
        for (int frame = 0; frame < frames; ++frame) {
            stage.step();
        }
        return stage.tunnelCount() - before;
    };
    const std::uint64_t first = missesIn(300);
    EXPECT_GT(missesIn(300), first / 2);
    EXPECT_LT(stage.tunnelMarks().size(), first);
    const std::uint64_t last = missesIn(15);
    EXPECT_EQ(stage.tunnelMarks().size(), last);
}

TEST(BulletStage, ShowsWhoLooksWhereBodiesAreThoughBulletFilesWhereTheyWere) {
    for (const char* name : {"hash", "dbvt", "simple"}) {
        BulletStage stage(worldNamed("bullet-storm"), 60, 1);
        stage.setBroadphase(kindNamed(name));
        float fastest = 0;
        for (int frame = 0; frame < 20; ++frame) {
            stage.step();
            for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
                const StageBody body = stage.body(index);
                if (body.shape != StageBody::Shape::sphere) {
                    continue;
                }
                fastest = std::max(fastest, body.speed);
                const Aabb<float>& filed = stage.grid()->box({index, 1});
                const Aabb<float> present = boxAround(body);
                ASSERT_TRUE(filed.contains(present)) << name << " in frame " << frame;
                ASSERT_LT((filed.sizes() - present.sizes()).maxCoeff(), 0.1F) << name;
            }
            expectPairs(stage, stage.broadphase().ours, name);
        }
        EXPECT_GT(fastest, 100) << name;
    }
}

TEST(BulletStage, TakesJointsOutWithABody) {
    BulletStage three(worldNamed("chains"), 3, 1);
    BulletStage four(worldNamed("chains"), 4, 1);
    EXPECT_EQ(four.remove(std::array{4U}), 1U);
    for (int frame = 0; frame < 120; ++frame) {
        three.step();
        four.step();
        ASSERT_EQ(four.placesHash(), three.placesHash()) << frame;
    }
    EXPECT_LT(three.body(3).centre.y(), 9.5F);
    // Whoever hung on it falls.
    four.remove(std::array{1U});
    for (int frame = 0; frame < 120; ++frame) {
        four.step();
    }
    EXPECT_LT(four.body(2).centre.y(), 1);
}

TEST(BulletStage, WakesWhoeverLeansOnABodyThatIsRemoved) {
    BulletStage stage(worldNamed("stack"), 20, 1);
    for (int frame = 0; frame < 400 && !stage.body(15).isAsleep; ++frame) {
        stage.step();
    }
    ASSERT_TRUE(stage.body(15).isAsleep);
    stage.remove(std::array{4U, 5U, 6U});
    EXPECT_FALSE(stage.body(15).isAsleep);
    for (int frame = 0; frame < 60; ++frame) {
        stage.step();
    }
    EXPECT_LT(stage.body(15).centre.y(), 0.5F);
}

TEST(BulletStage, PicksNobodyThroughTheGround) {
    BulletStage stage(worldNamed("pile"), 1, 1);
    const Vector3<float> middle = stage.body(1).centre;
    const Vector3<float> below(middle.x(), -3, middle.z());
    EXPECT_TRUE(stage.pick({below, middle}).id.isNull());
    EXPECT_EQ(stage.pick({middle + Vector3<float>(0, 5, 0), below}).id.index, 1U);
}

/// A world that nobody looks at.
struct BareWorld {
    BareWorld(const WorldSceneKind& scene, std::size_t objects, const SceneEffects& effects)
        : contents(world), configurator(fill(scene, objects)) {
        configurator.apply(worldEffectsOf(effects));
    }

    btDiscreteDynamicsWorld& fill(const WorldSceneKind& scene, std::size_t objects) {
        scene.fill(contents, objects, 1);
        return world;
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    WorldContents contents;
    WorldConfigurator configurator;
};

TEST(BulletStage, MovesBodiesAsBulletDoesWhereNobodyLooks) {
    for (const bool isSwept : {false, true}) {
        for (const char* scene : {"bullet-storm", "pile", "chains"}) {
            BulletStage stage(worldNamed(scene), 80, 1);
            SceneEffects effects = stage.effects();
            if (isSwept) {
                effects.declare(Effect::sweep);
            }
            stage.declare(effects);
            BareWorld bare(worldNamed(scene), 80, effects);
            for (int frame = 0; frame < 60; ++frame) {
                stage.step();
                bare.configurator.step(kFrameSeconds);
            }
            for (std::uint32_t index = 1; index < stage.indexLimit(); ++index) {
                const btVector3 place =
                    bare.contents.bodies()[index]->getWorldTransform().getOrigin();
                const Vector3<float> expected(place.x(), place.y(), place.z());
                ASSERT_EQ(stage.body(index).centre, expected) << scene << ", " << isSwept;
            }
        }
    }
}

TEST(InfoCard, CountsOtherBodiesAndNeitherTheBodyNorTheGround) {
    BulletStage stage(worldNamed("pile"), 1, 1);
    for (int frame = 0; frame < 300; ++frame) {
        stage.step();
    }
    const InfoCard alone = infoCard(stage, *stage.grid(), 1, 5);
    EXPECT_LT(alone.body.centre.y(), 2) << "lies on the ground";
    EXPECT_EQ(alone.load, 1U);
    EXPECT_EQ(alone.neighbours, 0U);
    EXPECT_EQ(alone.candidates, 0U);
    // A grid that has the body elsewhere.
    Grid<float> other;
    const Vector3<float> far = Vector3<float>::Constant(100);
    static_cast<void>(other.add({far, far}));
    static_cast<void>(other.add({far, far}));
    EXPECT_EQ(infoCard(stage, other, 1, 5).neighbours, 0U);
    EXPECT_EQ(infoCard(stage, other, 1, 5).candidates, 0U);
}

}  // namespace
}  // namespace hashphase::demos
