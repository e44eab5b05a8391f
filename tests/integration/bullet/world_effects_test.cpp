// SPDX-License-Identifier: Zlib

// Effects that Bullet is told to leave out: the physics that goes with each, and what comes back.

#include <tests/integration/bullet/dynamics.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_cost.hpp>
#include <integration/bullet/world_effects.hpp>
#include <integration/effects/bullet_frame.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

extern int gNumClampedCcdMotions;  // Bullet's own count of sweeps

namespace hashphase::test {
namespace {

constexpr auto kSixtieth = btScalar(1) / 60;

btTransform upAt(const btVector3& place, btScalar tilt = 0) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), tilt), place);
}

std::unique_ptr<DynamicsWorld> canonicalHashWorld() {
    auto cache =
        std::make_unique<PairCache>(PairOrder::canonical, [](const btBroadphaseProxy& proxy) {
            return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
        });
    PairCache* const given = cache.get();
    return std::make_unique<DynamicsWorld>(std::make_unique<SpatialHashBroadphase>(given),
                                           std::move(cache));
}

/// A floor, body 0, and what is put on it.
struct EffectsRoom {
    explicit EffectsRoom(btScalar slope = 0) : scene(canonicalHashWorld()) {
        add(btVector3(50, 1, 50), 0, upAt(upAt({0, 0, 0}, slope) * btVector3(0, -1, 0), slope));
    }
    explicit EffectsRoom(std::unique_ptr<btBroadphaseInterface> broadphase)
        : scene(std::make_unique<DynamicsWorld>(std::move(broadphase))) {
        add(btVector3(50, 1, 50), 0, upAt({0, -1, 0}));
    }

    btRigidBody& add(const btVector3& halfExtents, btScalar mass, const btTransform& place) {
        return scene->body(
            scene->add(scene->keep(std::make_unique<btBoxShape>(halfExtents)), mass, place));
    }
    btRigidBody& addCube(const btVector3& place) {
        return add({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1, upAt(place));
    }
    btRigidBody& addBall(const btVector3& place, const btVector3& velocity) {
        auto* const shape = scene->keep(std::make_unique<btSphereShape>(btScalar(0.1)));
        btRigidBody& ball = scene->body(scene->add(shape, 1, upAt(place)));
        ball.setLinearVelocity(velocity);
        return ball;
    }
    btDiscreteDynamicsWorld& world() { return scene->world(); }
    WorldCost cost() { return costOf(scene->world()); }

    std::unique_ptr<DynamicsWorld> scene;
};

void run(WorldConfigurator& configurator, int steps) {
    for (int i = 0; i < steps; ++i) {
        configurator.step(kSixtieth);
    }
}

const btVector3& whereIs(const btRigidBody& body) {
    return body.getWorldTransform().getOrigin();
}

/// The subset of the six effects that a number between 0 and 63 stands for.
WorldEffects subset(int number) {
    WorldEffects effects;
    int bit = 1;
    for (bool* const effect : {&effects.pairs, &effects.response, &effects.sweep, &effects.sleeping,
                               &effects.rotation, &effects.friction}) {
        *effect = (number & bit) != 0;
        bit *= 2;
    }
    effects.fastFrom = btScalar(0.5);
    return effects;
}

TEST(WorldEffects, ThatAreAllDeclaredMoveBodiesAsInAnUntouchedWorld) {
    int sleepers = 0;
    for (const int number : {1, 2}) {
        const DynamicsScene& script = dynamicsScenes()[static_cast<std::size_t>(number)];
        const auto untouched = canonicalHashWorld();
        const auto configured = canonicalHashWorld();
        script.build(*untouched);
        script.build(*configured);
        WorldConfigurator configurator(configured->world());
        configurator.apply({});
        EXPECT_EQ(configurator.heldCount(), 0U);
        for (int step = 0; step < 200; ++step) {
            untouched->step();
            configurator.step(kSixtieth);
            ASSERT_EQ(firstDifferentBody(*untouched, *configured), -1)
                << script.name << " after step " << step;
            sleepers += configured->sleepingCount();
        }
    }
    EXPECT_GT(sleepers, 0);
}

TEST(WorldEffects, WithoutPairsHaveNoneUnderAnyBroadphase) {
    for (int kind = 0; kind < 3; ++kind) {
        std::unique_ptr<btBroadphaseInterface> broadphase;
        if (kind == 0) {
            broadphase = std::make_unique<SpatialHashBroadphase>();
        } else if (kind == 1) {
            broadphase = std::make_unique<btDbvtBroadphase>();
        } else {
            broadphase = std::make_unique<btSimpleBroadphase>();
        }
        EffectsRoom room(std::move(broadphase));
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
        EXPECT_EQ(room.cost().pairCount, 1) << kind;
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
        room.add({btScalar(0.005), 5, 5}, 0, upAt({0, 5, 0}));
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
    }
}

TEST(WorldEffects, WithoutFrictionSlideDownASlopeThatHoldsThemOtherwise) {
    for (const bool isDeclared : {true, false}) {
        EffectsRoom room(btScalar(0.1));
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

TEST(WorldEffects, WithoutRotationStandOnAnEdge) {
    for (const bool isDeclared : {true, false}) {
        EffectsRoom room;
        btRigidBody& pillar = room.add({btScalar(0.2), 1, btScalar(0.2)}, 1,
                                       upAt({0, btScalar(1.1), 0}, btScalar(0.4)));
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
    run(configurator, 200);
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

/// Everything of a body that may be overridden, and of its world.
std::vector<btScalar> settingsOf(DynamicsWorld& scene) {
    std::vector<btScalar> settings;
    const auto note = [&](auto value) { settings.push_back(static_cast<btScalar>(value)); };
    for (int i = 0; i < scene.bodyCount(); ++i) {
        const btRigidBody& body = scene.body(i);
        note(body.getCollisionFlags());
        note(body.getFlags());
        for (int axis = 0; axis < 3; ++axis) {
            note(body.getAngularFactor()[axis]);
        }
        for (const btScalar value :
             {body.getFriction(), body.getRollingFriction(), body.getSpinningFriction(),
              body.getRestitution(), body.getCcdMotionThreshold(), body.getCcdSweptSphereRadius(),
              body.getLinearSleepingThreshold(), body.getAngularSleepingThreshold()}) {
            note(value);
        }
        note(body.getActivationState() == DISABLE_DEACTIVATION);
    }
    note(scene.world().getDispatchInfo().m_useContinuous);
    note(scene.world().getSolverInfo().m_solverMode);
    note(scene.world().getPairCache()->getOverlapFilterCallback() != nullptr);
    return settings;
}

/// Cubes in heaps, a fast ball, and settings unlike each other's.
void fillWithSettings(EffectsRoom& room) {
    for (int i = 0; i < 8; ++i) {
        btRigidBody& cube = room.addCube({btScalar(i / 4) * 3, btScalar(i % 4) + btScalar(0.5), 0});
        cube.setFriction(btScalar(0.3) + btScalar(i) / 10);
        cube.setRollingFriction(btScalar(i) / 100);
        cube.setRestitution(btScalar(i) / 10);
        cube.setCcdMotionThreshold(btScalar(i % 2));
        cube.setAngularFactor({1, btScalar(i % 2), 1});
        cube.setFlags(i % 3 == 0 ? 0 : BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD);
        cube.setSleepingThresholds(btScalar(0.1) * btScalar(i), 1);
        if (i % 5 == 0) {
            cube.setActivationState(DISABLE_DEACTIVATION);
        }
    }
    room.addBall({-6, 2, 0}, {200, 0, 0})
        .setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    room.world().getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
}

TEST(WorldEffects, CostNothingWhereUndeclaredAndGiveBackAllSettingsInAllSubsets) {
    EffectsRoom room;
    fillWithSettings(room);
    const std::vector<btScalar> own = settingsOf(*room.scene);
    for (int number = 0; number < 64; ++number) {
        WorldConfigurator configurator(room.world());
        const WorldEffects effects = subset(number);
        configurator.apply(effects);
        for (int step = 0; step < 20; ++step) {
            const int sweepsBefore = gNumClampedCcdMotions;
            configurator.step(kSixtieth);
            const WorldCost cost = room.cost();
            const bool answers = effects.pairs && effects.response;
            EXPECT_TRUE(effects.pairs ||
                        (cost.pairCount == 0 && cost.manifoldCount == 0 && cost.contactCount == 0));
            EXPECT_TRUE(answers || cost.answeredContactCount == 0) << number;
            EXPECT_TRUE((answers && effects.friction) || cost.rubbingContactCount == 0) << number;
            EXPECT_TRUE((answers && effects.sweep) ||
                        (cost.sweptCount == 0 && gNumClampedCcdMotions == sweepsBefore));
            EXPECT_TRUE(effects.sleeping || cost.sleepingCount == 0) << number;
            EXPECT_TRUE(effects.rotation || cost.turningCount == 0) << number;
        }
        configurator.apply({});
        EXPECT_EQ(settingsOf(*room.scene), own) << number;
        EXPECT_EQ(configurator.heldCount(), 0U);
        configurator.apply(effects);
    }
    EXPECT_EQ(settingsOf(*room.scene), own) << "given back by the destructor";
    EXPECT_TRUE(room.world().getForceUpdateAllAabbs());
}

TEST(WorldEffects, BelieveWhoChangesASettingMeanwhile) {
    EffectsRoom room;
    btRigidBody& cube = room.addCube({0, 2, 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({.friction = false});
    cube.setFriction(btScalar(0.9));
    configurator.apply({.friction = false});
    EXPECT_EQ(cube.getFriction(), 0);
    configurator.apply({});
    EXPECT_EQ(cube.getFriction(), btScalar(0.9));
}

TEST(WorldEffects, FollowBodiesThatComeAndGo) {
    EffectsRoom room;
    btRigidBody& first = room.addCube({0, 2, 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({.rotation = false});
    btRigidBody& second = room.addCube({5, 2, 0});
    EXPECT_EQ(second.getAngularFactor(), btVector3(1, 1, 1));
    configurator.prepare(second);
    EXPECT_EQ(second.getAngularFactor(), btVector3(0, 0, 0));
    EXPECT_EQ(configurator.heldCount(), 2U);
    configurator.release(second);
    EXPECT_EQ(second.getAngularFactor(), btVector3(1, 1, 1));
    // Without being released: it is not touched any more.
    room.world().removeRigidBody(&first);
    configurator.apply({});
    EXPECT_EQ(first.getAngularFactor(), btVector3(0, 0, 0));
    EXPECT_EQ(configurator.heldCount(), 0U);
    room.world().addRigidBody(&first);
}

TEST(WorldEffects, TakeABodyMadeWhereAnotherWasForWhatItIs) {
    EffectsRoom room;
    btSphereShape shape(1);
    alignas(btRigidBody) std::array<std::byte, sizeof(btRigidBody)> memory;
    WorldConfigurator configurator(room.world());
    WorldEffects effects{.friction = false};
    for (const auto friction : {btScalar(0.7), btScalar(0.2)}) {
        auto* const body = new (memory.data()) btRigidBody(1, nullptr, &shape, {1, 1, 1});
        body->setFriction(friction);
        room.world().addRigidBody(body);
        configurator.apply(effects);
        EXPECT_EQ(body->getFriction(), 0);
        if (friction < btScalar(0.5)) {
            configurator.apply({});
            EXPECT_EQ(body->getFriction(), friction);
        }
        room.world().removeRigidBody(body);
        body->~btRigidBody();
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
    configurator.apply(effects);
    run(configurator, 40);
    EXPECT_EQ(room.cost().pairCount, 2);
    EXPECT_LT(whereIs(ghostly).y(), 0);
    EXPECT_LT(whereIs(sensor).y(), 0);
    EXPECT_GT(whereIs(other).y(), btScalar(0.4));
    EXPECT_GT(room.cost().contactCount, room.cost().answeredContactCount);
}

TEST(WorldEffects, KeepTheFilterThatTheWorldHad) {
    struct Nobody : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override {
            return false;
        }
    } nobody;
    EffectsRoom room;
    room.addCube({0, btScalar(0.5), 0});
    room.world().getPairCache()->setOverlapFilterCallback(&nobody);
    WorldConfigurator configurator(room.world());
    configurator.apply({.effectsOf = [](const btCollisionObject&) { return BodyEffects(); }});
    run(configurator, 2);
    EXPECT_EQ(room.cost().pairCount, 0);
    configurator.apply({});
    EXPECT_EQ(room.world().getPairCache()->getOverlapFilterCallback(), &nobody);
    room.world().getPairCache()->setOverlapFilterCallback(nullptr);
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
    scene.response->restitution = 0.25;
    WorldEffects effects = worldEffectsOf(scene);
    EXPECT_TRUE(effects.motion && effects.pairs && effects.response);
    EXPECT_FALSE(effects.sweep || effects.sleeping || effects.rotation || effects.friction);
    EXPECT_EQ(effects.restitution, btScalar(0.25));
    EXPECT_FALSE(effects.fastFrom || effects.slowBelow);
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
