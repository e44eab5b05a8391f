// SPDX-License-Identifier: Zlib

// Effects that Bullet is told to leave out: the physics that goes with each.

#include <tests/integration/bullet/effects_room.hpp>

#include <integration/effects/bullet_frame.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <utility>

extern int gNumClampedCcdMotions;  // Bullet's own count of sweeps

namespace hashphase::test {
namespace {

TEST(WorldEffects, ThatAreAllDeclaredMoveBodiesAsInAnUntouchedWorld) {
    int sleepers = 0;
    const auto untouched = canonicalWorld(hashOverPairCache);
    const auto configured = canonicalWorld(hashOverPairCache);
    for (DynamicsWorld* const world : {untouched.get(), configured.get()}) {
        buildPile(*world);
        world->addBox({1, 1, 1}, 1, {20, 1, 20});  // which comes to rest
    }
    WorldConfigurator configurator(configured->world());
    configurator.apply({});
    EXPECT_EQ(configurator.heldCount(), 0U);
    for (int step = 0; step < 300; ++step) {
        untouched->step();
        configurator.step(kSixtieth);
        ASSERT_EQ(firstDifferentBody(*untouched, *configured), -1) << "after step " << step;
        sleepers += configured->sleepingCount();
    }
    EXPECT_GT(sleepers, 0);
}

TEST(WorldEffects, WithoutPairsHaveNoneUnderAnyBroadphase) {
    for (const auto make : {makeBroadphase<SpatialHashBroadphase>, makeBroadphase<btDbvtBroadphase>,
                            makeBroadphase<btSimpleBroadphase>}) {
        EffectsRoom room(make());
        btRigidBody& cube = room.addCube({0, btScalar(0.5), 0});
        WorldConfigurator configurator(room.world());
        run(configurator, 10);
        EXPECT_EQ(room.cost().pairCount, 1);
        configurator.apply({.pairs = false});
        EXPECT_EQ(room.cost().pairCount, 0) << "at once";
        run(configurator, 10);
        EXPECT_EQ(room.cost().manifoldCount, 0);
        EXPECT_LT(whereIs(cube).y(), btScalar(0.4));
        configurator.apply({});
        run(configurator, 1);
        EXPECT_EQ(room.cost().pairCount, 1);
        EXPECT_EQ(room.body(0).getBroadphaseProxy()->m_aabbMax.y(), gContactBreakingThreshold);
        EXPECT_GT(room.cost().contactCount, 0);
    }
}

TEST(WorldEffects, WithoutResponseTellContactsAndFallThrough) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, btScalar(0.6), 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({.response = false});
    run(configurator, 20);
    EXPECT_GT(room.cost().contactCount, 0);
    EXPECT_EQ(room.cost().answeredContactCount, 0);
    run(configurator, 60);
    EXPECT_LT(whereIs(cube).y(), -2);
}

TEST(WorldEffects, WakeBodiesWhenTheyChange) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, btScalar(0.5), 0});
    WorldConfigurator configurator(room.world());
    run(configurator, 200);
    EXPECT_FALSE(cube.isActive());
    configurator.apply({.sweep = false});
    EXPECT_FALSE(cube.isActive()) << "nothing is changed for it";
    configurator.apply({.response = false});
    run(configurator, 60);
    EXPECT_LT(whereIs(cube).y(), -2);
}

// 4 m a step, through a wall 1 cm thick.
TEST(WorldEffects, WithSweepStopAtAThinWallAndWithoutPassIt) {
    for (const bool isDeclared : {true, false}) {
        EffectsRoom room;
        room.world().setGravity({0, 0, 0});
        room.addBox({btScalar(0.005), 5, 5}, 0, {0, 5, 0});
        btRigidBody& fast = room.addBall({-6, 5, 0}, {240, 0, 0});
        btRigidBody& slow = room.addBall({-6, 8, 0}, {2, 0, 0});
        for (btRigidBody* const ball : {&fast, &slow}) {
            ball->setGravity({0, 0, 0});
        }
        WorldConfigurator configurator(room.world());
        configurator.apply({.sweep = isDeclared, .fastFrom = btScalar(0.5)});
        const int sweepsBefore = gNumClampedCcdMotions;
        EXPECT_EQ(configurator.beforeStep(kSixtieth), isDeclared ? 1 : 0);
        run(configurator, 1);
        EXPECT_EQ(room.cost().sweptCount, isDeclared ? 1 : 0);
        run(configurator, 59);
        EXPECT_EQ(whereIs(fast).x() < 0, isDeclared);
        EXPECT_EQ(gNumClampedCcdMotions > sweepsBefore, isDeclared);
        // The other was slow in every step: nobody's way is boxed any more.
        EXPECT_EQ(configurator.beforeStep(kSixtieth), 0);
        EXPECT_FALSE(room.world().getDispatchInfo().m_useContinuous);
        slow.setLinearVelocity({0, 240, 0});
        EXPECT_EQ(configurator.beforeStep(kSixtieth), isDeclared ? 1 : 0);
        EXPECT_EQ(room.world().getDispatchInfo().m_useContinuous, isDeclared);
    }
}

// A ball 20 cm wide, a wall 1 cm thick, and twelve moments of a step at which they may meet.
TEST(WorldEffects, PassNoThinWallWhenSweptFromHalfTheirWidthOnAndSomeFromMore) {
    for (const auto fastFrom : {btScalar(0.5), btScalar(1)}) {
        int passedCount = 0;
        for (const auto share : {btScalar(0.45), btScalar(0.9), btScalar(3)}) {
            for (int i = 0; i < 12; ++i) {
                EffectsRoom room;
                room.world().setGravity({0, 0, 0});
                room.addBox({btScalar(0.005), 5, 5}, 0, {0, 5, 0});
                const btScalar way = share * btScalar(0.2);
                btRigidBody& ball =
                    room.addBall({-1 - way * btScalar(i) / 12, 5, 0}, {way / kSixtieth, 0, 0});
                WorldConfigurator configurator(room.world());
                configurator.apply({.fastFrom = fastFrom});
                run(configurator, static_cast<int>(2 / way));
                passedCount += whereIs(ball).x() > 0;
            }
        }
        EXPECT_EQ(passedCount > 0, fastFrom > btScalar(0.5));
    }
}

TEST(WorldEffects, WithoutFrictionSlideDownASlopeThatHoldsThemOtherwise) {
    for (const bool isDeclared : {true, false}) {
        EffectsRoom room(makeBroadphase<SpatialHashBroadphase>(), btScalar(0.1));
        btRigidBody& cube = room.addCube({0, btScalar(0.51), 0});
        run(*std::make_unique<WorldConfigurator>(room.world()), 60);
        const btScalar start = whereIs(cube).x();
        WorldConfigurator configurator(room.world());
        configurator.apply({.friction = isDeclared});
        run(configurator, 60);
        EXPECT_GT(room.cost().answeredContactCount, 0);
        EXPECT_EQ(room.cost().rubbingContactCount > 0, isDeclared);
        // g sin(0.1) for a second
        EXPECT_NEAR(whereIs(cube).x() - start, isDeclared ? 0 : -0.49, 0.02);
    }
}

TEST(WorldEffects, RubAtOnceOrNoMoreWhereBodiesTouchAlready) {
    EffectsRoom room;
    room.addCube({0, btScalar(0.5), 0});
    WorldConfigurator configurator(room.world());
    run(configurator, 10);
    const int rubbingCount = room.cost().rubbingContactCount;
    EXPECT_GT(rubbingCount, 0);
    configurator.apply({.friction = false});
    EXPECT_EQ(room.cost().rubbingContactCount, 0);
    configurator.apply({});
    EXPECT_EQ(room.cost().rubbingContactCount, rubbingCount);
}

TEST(WorldEffects, WithoutRotationStopBodiesThatTurn) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, 9, 0});
    cube.setAngularVelocity({0, 3, 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({});
    EXPECT_EQ(room.cost().turningCount, 1);
    configurator.apply({.rotation = false});
    EXPECT_EQ(room.cost().turningCount, 0);
    EXPECT_EQ(cube.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY, 0);
}

TEST(WorldEffects, WithoutRotationStandOnAnEdge) {
    for (const bool isDeclared : {true, false}) {
        EffectsRoom room;
        btRigidBody& pillar = room.addTilted({btScalar(0.2), 1, btScalar(0.2)}, 1,
                                             {0, btScalar(1.1), 0}, btScalar(0.4));
        WorldConfigurator configurator(room.world());
        configurator.apply({.rotation = isDeclared});
        run(configurator, 30);
        EXPECT_EQ(room.cost().turningCount, isDeclared ? 1 : 0);
        run(configurator, 90);
        EXPECT_EQ(whereIs(pillar).y() < btScalar(0.5), isDeclared);
    }
}

TEST(WorldEffects, WithoutSleepingKeepBodiesAwakeAndWakeThose) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, btScalar(0.5), 0});
    btRigidBody& wakeful = room.addCube({5, btScalar(0.5), 0});
    wakeful.setActivationState(DISABLE_DEACTIVATION);
    WorldConfigurator configurator(room.world());
    run(configurator, 200);
    EXPECT_EQ(room.cost().sleepingCount, 1);
    configurator.apply({.sleeping = false});
    EXPECT_EQ(room.cost().awakeCount, 2);
    run(configurator, 200);
    EXPECT_EQ(room.cost().sleepingCount, 0);
    configurator.apply({});
    EXPECT_EQ(cube.getActivationState(), ACTIVE_TAG);
    EXPECT_EQ(wakeful.getActivationState(), DISABLE_DEACTIVATION) << "as its owner wishes";
    run(configurator, 60);
    EXPECT_EQ(room.cost().sleepingCount, 0) << "they get the time that they would have had";
    run(configurator, 140);
    EXPECT_EQ(room.cost().sleepingCount, 1);
}

TEST(WorldEffects, PutToSleepWhatIsSlowerThanDeclared) {
    EffectsRoom room;
    room.world().setGravity({0, 0, 0});
    btRigidBody& cube = room.addCube({0, 9, 0});
    cube.setLinearVelocity({1, 0, 0});
    WorldConfigurator configurator(room.world());
    run(configurator, 150);
    EXPECT_EQ(room.cost().sleepingCount, 0);
    configurator.apply({.slowBelow = btScalar(1.5)});
    run(configurator, 150);
    EXPECT_EQ(room.cost().sleepingCount, 1);
    configurator.apply({});
    EXPECT_EQ(cube.getLinearSleepingThreshold(), btScalar(0.8));
}

TEST(WorldEffects, BounceAsMuchAsDeclared) {
    for (const auto restitution : {btScalar(0), btScalar(0.64), btScalar(1)}) {
        EffectsRoom room;
        btRigidBody& cube = room.addCube({0, btScalar(0.6), 0});
        cube.setLinearVelocity({0, -6, 0});
        WorldConfigurator configurator(room.world());
        configurator.apply({.restitution = restitution});
        run(configurator, 3);
        EXPECT_NEAR(cube.getLinearVelocity().y(), 6 * restitution, 0.5);
    }
}

TEST(WorldEffects, AreNarrowedForSingleBodies) {
    EffectsRoom room;
    btRigidBody& ghostly = room.addCube({0, 1, 0});
    btRigidBody& sensor = room.addCube({3, 1, 0});
    btRigidBody& other = room.addCube({6, 1, 0});
    WorldConfigurator configurator(room.world());
    WorldEffects effects;
    effects.effectsOf = [&](const btCollisionObject& object) {
        return BodyEffects{.pairs = &object != &ghostly, .response = &object != &sensor};
    };
    effects.fastFrom = 1;
    run(configurator, 20);
    EXPECT_EQ(room.cost().pairCount, 3);
    configurator.apply(effects);
    EXPECT_EQ(sensor.getCcdMotionThreshold(), 0) << "it would be swept in vain";
    EXPECT_EQ(other.getCcdMotionThreshold(), 1);
    EXPECT_EQ(room.cost().pairCount, 2) << "at once";
    run(configurator, 40);
    EXPECT_LT(whereIs(ghostly).y(), 0);
    EXPECT_LT(whereIs(sensor).y(), 0);
    EXPECT_GT(whereIs(other).y(), btScalar(0.4));
    EXPECT_GT(room.cost().contactCount, room.cost().answeredContactCount);
}

TEST(WorldEffects, WithoutMotionFindPairsOfBodiesAsTheyStand) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, btScalar(0.5), 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({.motion = false});
    run(configurator, 5);
    EXPECT_EQ(whereIs(cube), btVector3(0, btScalar(0.5), 0));
    EXPECT_GT(room.cost().contactCount, 0);
}

TEST(BulletFrame, PutsADeclarationInBulletsTerms) {
    SceneEffects scene;
    for (const Effect effect : {Effect::motion, Effect::pairs, Effect::response}) {
        scene.declare(effect);
    }
    scene.response->restitution = 0.25;  // bodies have their own
    WorldEffects effects = worldEffectsOf(scene);
    EXPECT_TRUE(effects.motion && effects.pairs && effects.response);
    EXPECT_FALSE(effects.sweep || effects.sleeping || effects.rotation || effects.friction);
    EXPECT_FALSE(effects.restitution || effects.fastFrom || effects.slowBelow);
    scene.sweep = SweepEffect{.fastFrom = 0.5};
    scene.sleeping = SleepingEffect{.slowBelow = 2};
    effects = worldEffectsOf(scene);
    EXPECT_EQ(effects.fastFrom, btScalar(0.5));
    EXPECT_EQ(effects.slowBelow, btScalar(2));
}

TEST(BulletFrame, RefusesWhatBulletHasNotOrWhatContradictsItself) {
    SceneEffects scene;
    scene.declare(Effect::friction);
    EXPECT_THROW(static_cast<void>(worldEffectsOf(scene)), std::invalid_argument);
    scene = {};
    scene.motion =
        MotionEffect{.bounds = Aabb<double>(Vector3<double>(-1, -1, -1), Vector3<double>(1, 1, 1))};
    EXPECT_EQ(bulletEffectsError(scene).find("motion.bounds"), 0U);
    scene.motion = MotionEffect();
    EXPECT_EQ(bulletEffectsError(scene), "");
    scene.sleeping = SleepingEffect{.interestRadius = 100};
    EXPECT_EQ(bulletEffectsError(scene).find("sleeping.interestRadius"), 0U);
}

}  // namespace
}  // namespace hashphase::test
