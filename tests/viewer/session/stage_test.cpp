// SPDX-License-Identifier: Zlib

#include <demos/scenes/result_hash.hpp>
#include <demos/viewer/session/info_card.hpp>
#include <demos/viewer/session/pair_check.hpp>
#include <demos/viewer/stage/body_shape.hpp>
#include <demos/viewer/stage/bullet_stage.hpp>
#include <demos/viewer/stage/paper_stage.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/effects/bullet_frame.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

/// Spheres so close together that many touch in each frame.
EffectsFile throng() {
    EffectsFile file;
    file.scene.objects = 300;
    file.scene.domain = 40;
    file.scene.terrain = 10;
    for (const Effect effect :
         {Effect::motion, Effect::terrain, Effect::pairs, Effect::response, Effect::picking,
          Effect::boxSelection, Effect::culling, Effect::proximity}) {
        file.effects.declare(effect);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    file.effects.motion->bounds = {Vector3<double>(1, -infinity, 1),
                                   Vector3<double>(39, infinity, 39)};
    return file;
}

TEST(PaperStage, MovesBodiesInTheSameWayWhoeverFindsThePairs) {
    std::vector<std::unique_ptr<PaperStage>> stages;
    for (const BroadphaseKind& kind : broadphaseKinds()) {
        stages.push_back(std::make_unique<PaperStage>(throng()));
        stages.back()->setBroadphase(kind);
    }
    // The last one goes from one to the next.
    stages.push_back(std::make_unique<PaperStage>(throng()));
    std::size_t pairs = 0;
    for (std::size_t frame = 0; frame < 60; ++frame) {
        stages.back()->setBroadphase(broadphaseKinds()[frame / 4 % broadphaseKinds().size()]);
        for (const auto& stage : stages) {
            stage->step();
            ASSERT_EQ(stage->placesHash(), stages.front()->placesHash())
                << stage->broadphase().name << " in frame " << frame;
            expectPairs(*stage, stage->broadphase().ours || stage->broadphase().name == "simple",
                        std::string(stage->broadphase().name));
        }
        std::vector<PairKey> found;
        stages.front()->listPairs(found);
        pairs += found.size();
    }
    EXPECT_GT(pairs, 60U * 100);
}

TEST(PaperStage, RunsWhatIsDeclaredAlone) {
    PaperStage stage(throng());
    const auto has = [&stage](std::string_view phase) {
        return std::any_of(stage.times().begin(), stage.times().end(),
                           [phase](const PhaseTime& time) { return time.name == phase; });
    };
    stage.step();
    for (const char* phase : {"stand", "pair", "respond", "culling", "proximity"}) {
        EXPECT_TRUE(has(phase)) << phase;
    }
    SceneEffects effects = stage.effects();
    for (const Effect effect :
         {Effect::terrain, Effect::response, Effect::pairs, Effect::culling, Effect::proximity}) {
        effects.remove(effect);
    }
    stage.declare(effects);
    stage.step();
    for (const char* phase : {"stand", "pair", "respond", "culling", "proximity"}) {
        EXPECT_FALSE(has(phase)) << phase;
    }
    EXPECT_TRUE(stage.ground().empty());
}

TEST(PaperStage, GoesOnWithPairsThatWereTakenBackAndWithoutBodiesThatWereRemoved) {
    PaperStage stage(throng());
    SceneEffects all = stage.effects();
    SceneEffects without = all;
    without.remove(Effect::response);
    without.remove(Effect::pairs);
    for (std::uint32_t frame = 0; frame < 40; ++frame) {
        if (frame % 10 == 0) {
            stage.declare(without);
        } else if (frame % 10 == 5) {
            stage.declare(all);
        }
        stage.setBroadphase(kindNamed(frame % 3 == 0 ? "dbvt" : "hash"));
        EXPECT_EQ(stage.remove(std::array{frame}), 1U);
        EXPECT_EQ(stage.remove(std::array{frame}), 0U);
        stage.step();
        if (stage.effects().pairs) {
            expectPairs(stage, frame % 3 != 0, "frame " + std::to_string(frame));
        }
    }
    EXPECT_EQ(stage.size(), 260U);
}

TEST(PaperStage, RefusesToSweepWithPairsOfAnother) {
    PaperStage stage(throng());
    SceneEffects effects = stage.effects();
    effects.declare(Effect::sweep);
    stage.declare(effects);
    EXPECT_THROW(stage.setBroadphase(kindNamed("dbvt")), std::invalid_argument);
    effects.remove(Effect::sweep);
    stage.declare(effects);
    stage.setBroadphase(kindNamed("dbvt"));
    effects.declare(Effect::sweep);
    EXPECT_THROW(stage.declare(effects), std::invalid_argument);
}

SceneEffects withoutMotion(SceneEffects effects) {
    for (const Effect effect : {Effect::response, Effect::terrain, Effect::motion}) {
        effects.remove(effect);
    }
    return effects;
}

TEST(PaperStage, GivesBodiesTheirVelocitiesBackWhenMotionIsDeclaredAgain) {
    const EffectsFile file = throng();
    EffectsFile still = file;
    still.effects = withoutMotion(file.effects);
    PaperStage moving(file);
    PaperStage stopped(file);
    PaperStage stillAtFirst(still);
    stillAtFirst.step();
    stillAtFirst.declare(file.effects);
    for (int frame = 0; frame < 30; ++frame) {
        if (frame % 10 == 0) {
            const std::uint64_t places = stopped.placesHash();
            stopped.declare(withoutMotion(file.effects));
            EXPECT_EQ(stopped.body(5).speed, 0);
            stopped.step();
            EXPECT_EQ(stopped.placesHash(), places);
            stopped.declare(file.effects);
        }
        moving.step();
        stopped.step();
        stillAtFirst.step();
        ASSERT_EQ(stopped.placesHash(), moving.placesHash()) << frame;
        ASSERT_EQ(stillAtFirst.placesHash(), moving.placesHash()) << frame;
    }
    EXPECT_GT(moving.body(5).speed, 0);
}

TEST(PaperStage, PushesOnlyBodiesThatMove) {
    EffectsFile file = throng();
    file.scene.moving = 0.5;
    PaperStage stage(file);
    std::size_t pushed = 0;
    for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
        const StageBody before = stage.body(index);
        EXPECT_EQ(stage.push(index, {0, 0, 50}), !before.isStatic);
        EXPECT_EQ(stage.body(index).speed > 0, !before.isStatic);
        pushed += before.isStatic ? 0 : 1;
    }
    EXPECT_GT(pushed, 100U);
    EXPECT_LT(pushed, 200U);
}

TEST(PaperStage, PicksNobodyThroughTheGround) {
    PaperStage stage(throng());
    stage.step();
    std::size_t seen = 0;
    for (std::uint32_t index = 0; index < stage.indexLimit(); ++index) {
        const Vector3<float> middle = stage.body(index).centre;
        EXPECT_TRUE(stage.pick({middle - Vector3<float>(0, 30, 0), middle}).id.isNull()) << index;
        seen += stage.pick({middle + Vector3<float>(0, 2, 0), middle}).id.index == index ? 1 : 0;
    }
    EXPECT_GT(seen, 200U);
    // Nobody hides them where there is no ground.
    stage.declare(withoutMotion(stage.effects()));
    const Vector3<float> middle = stage.body(7).centre;
    EXPECT_FALSE(stage.pick({middle - Vector3<float>(0, 30, 0), middle}).id.isNull());
}

// --- The check itself ----------------------------------------------------------------------------

/// Brute force that does not see pairs of a body with index 3.
class BlindBroadphase : public btSimpleBroadphase {
public:
    explicit BlindBroadphase(int size) : btSimpleBroadphase(size) {
        getOverlappingPairCache()->setOverlapFilterCallback(&filter_);
    }

private:
    struct Filter : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            return FilledBroadphase::objectOf(*a) != 3 && FilledBroadphase::objectOf(*b) != 3;
        }
    };
    Filter filter_;
};

TEST(PairCheck, SeesThatPairsAreMissing) {
    constexpr BroadphaseKind kBlind{
        "blind",
        "blind",
        "blind to one body",
        false,
        0,
        true,
        [](const BroadphaseNeeds& needs) -> std::unique_ptr<btBroadphaseInterface> {
            return std::make_unique<BlindBroadphase>(static_cast<int>(needs.objects) + 16);
        }};
    PaperStage stage(throng());
    stage.setBroadphase(kBlind);
    PairCheck check;
    std::size_t missing = 0;
    for (int frame = 0; frame < 30; ++frame) {
        stage.step();
        check.look(stage);
        for (const PairKey pair : check.missing()) {
            EXPECT_TRUE(firstOf(pair) == 3 || secondOf(pair) == 3);
        }
        missing += check.missing().size();
    }
    EXPECT_GT(missing, 0U);
}

// --- Bullet's scenes -----------------------------------------------------------------------------

TEST(BulletStage, KeepsIndicesAndPairsWhenTheBroadphaseIsSwapped) {
    BulletStage stage(worldNamed("pile"), 150, 1, worldEffects());
    EXPECT_EQ(stage.remove(std::array{0U, 7U}), 1U);  // not the floor
    std::size_t frame = 0;
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
        frame += 20;
    }
    EXPECT_EQ(stage.size(), 150U);
    EXPECT_GT(frame, 0U);
}

TEST(BulletStage, FilesBodiesInCellsOfTheDeclaredSize) {
    BulletStage stage(worldNamed("pile"), 150, 1, worldEffects());
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
    SceneEffects effects = worldEffects();
    effects.declare(Effect::proximity);
    BulletStage stage(worldNamed("stack"), 200, 1, worldEffects());
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
    expectEvenColours(BulletStage(worldNamed("stack"), 200, 1, effects));
}

TEST(BulletStage, HearsBulletsOwnZones) {
    BulletStage stage(worldNamed("pile"), 50, 1, worldEffects());
    stage.step();
    const auto zones = stage.zones();
    ASSERT_FALSE(zones.empty());
    EXPECT_EQ(zones.front().depth, 0);
    const auto isThere = [&](std::string_view name) {
        return std::any_of(zones.begin(), zones.end(),
                           [name](const Stage::Zone& zone) { return zone.name == name; });
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
    SceneEffects effects = worldEffects();
    BulletStage discrete(worldNamed("bullet-storm"), 60, 1, effects);
    effects.declare(Effect::sweep);
    BulletStage swept(worldNamed("bullet-storm"), 60, 1, effects);
    for (int frame = 0; frame < 60; ++frame) {
        discrete.step();
        swept.step();
    }
    EXPECT_GT(discrete.tunnelMarks().size(), 60U);
    EXPECT_EQ(swept.tunnelMarks().size(), 0U);
    for (const TunnelMark& mark : discrete.tunnelMarks()) {
        EXPECT_GT((mark.to - mark.from).norm(), 1);
    }
}

TEST(BulletStage, ShowsWhoLooksWhereBodiesAreThoughBulletFilesWhereTheyWere) {
    for (const char* name : {"hash", "dbvt", "simple"}) {
        BulletStage stage(worldNamed("bullet-storm"), 60, 1, worldEffects());
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
    BulletStage three(worldNamed("chains"), 3, 1, worldEffects());
    BulletStage four(worldNamed("chains"), 4, 1, worldEffects());
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
    BulletStage stage(worldNamed("stack"), 20, 1, worldEffects());
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
    BulletStage stage(worldNamed("pile"), 1, 1, worldEffects());
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
            SceneEffects effects = worldEffects();
            if (isSwept) {
                effects.declare(Effect::sweep);
            }
            BulletStage stage(worldNamed(scene), 80, 1, effects);
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
    BulletStage stage(worldNamed("pile"), 1, 1, worldEffects());
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

// --- Shapes --------------------------------------------------------------------------------------

TEST(BodyShape, IsMetWhereItsSurfaceIs) {
    StageBody body;
    body.shape = StageBody::Shape::sphere;
    body.centre = {10, 0, 0};
    body.size.setConstant(2);
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(body, {10, 1, 0}, {1, 0, 0}), 0);
    EXPECT_FALSE(meets(body, {0, 3, 0}, {20, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {7, 0, 0}));
    EXPECT_FALSE(meets(body, {0, 0, 0}, {-20, 0, 0}));
    body.shape = StageBody::Shape::box;
    body.size = {1, 2, 3};
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*meets(body, {0, 0, 0}, {16, 0, 0}), 0.5F);
    EXPECT_FALSE(meets(body, {0, 1.5F, 0}, {16, 0, 0}));
    EXPECT_LT((boxAround(body).min() - Vector3<float>(8, -1, -3)).norm(), 1e-5F);
}

TEST(BodyShape, OfACapsuleIsRoundAtItsEnds) {
    StageBody body;
    body.shape = StageBody::Shape::capsule;
    body.size = {1, 2, 0};
    const auto from = [&](const Vector3<float>& start, const Vector3<float>& way) {
        return meets(body, start, way);
    };
    EXPECT_FLOAT_EQ(*from({-5, 0, 0}, {10, 0, 0}), 0.4F);
    EXPECT_FLOAT_EQ(*from({0, 7, 0}, {0, -8, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*from({0, 1, 0}, {0, 10, 0}), 0);
    EXPECT_FLOAT_EQ(*from({-5, 2.6F, 0}, {10, 0, 0}), 0.42F);
    EXPECT_FALSE(from({-5, 3.1F, 0}, {10, 0, 0}));
    EXPECT_FALSE(from({-5, 2.9F, 0.9F}, {10, 0, 0})) << "the corner of its box";
    EXPECT_FALSE(from({0.9F, 5, 0.9F}, {0, -10, 0})) << "the edge of its box";
    body.orientation = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vector3<float>::UnitZ());
    EXPECT_FLOAT_EQ(*from({-8, 0, 0}, {10, 0, 0}), 0.5F);
}

TEST(Ground, IsMetFromEitherSideWhereItsNearestTriangleIs) {
    const std::vector<Vector3<float>> roofs{{0, 1, 0}, {4, 1, 0}, {0, 1, 4},
                                            {0, 2, 0}, {4, 2, 0}, {0, 2, 4}};
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 4, 1}, {0, -4, 0}), 0.5F);
    EXPECT_FLOAT_EQ(*meets(roofs, {1, 0, 1}, {0, 4, 0}), 0.25F);
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, -1, 0})) << "ends before";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {0, 4, 0})) << "looks away";
    EXPECT_FALSE(meets(roofs, {3, 4, 3}, {0, -4, 0})) << "beside it";
    EXPECT_FALSE(meets(roofs, {1, 4, 1}, {1, 0, 0})) << "along it";
}

}  // namespace
}  // namespace hashphase::demos
