// SPDX-License-Identifier: Zlib

// What is set on a world and its bodies, what is given back, and to whom.

#include <tests/integration/bullet/effects_room.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

extern int gNumClampedCcdMotions;  // Bullet's own count of sweeps

namespace hashphase::test {
namespace {

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
    effects.restingBoxes = number % 3 != 0;
    return effects;
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
    note(scene.world().getForceUpdateAllAabbs());
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

TEST(WorldConfigurator, CostNothingWhereUndeclaredAndGiveBackAllSettingsInAllSubsets) {
    EffectsRoom room;
    fillWithSettings(room);
    const std::vector<btScalar> own = settingsOf(room);
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
        EXPECT_EQ(settingsOf(room), own) << number;
        EXPECT_EQ(configurator.heldCount(), 0U);
        configurator.apply(effects);
    }
    EXPECT_EQ(settingsOf(room), own) << "given back by the destructor";
}

TEST(WorldConfigurator, FindBodiesWhereTheyRestUnlessTheirBoxesAreNotDeclared) {
    for (const bool areDeclared : {true, false}) {
        EffectsRoom room;
        btRigidBody& cube = room.addCube({0, 2, 0});
        cube.setMassProps(0, {0, 0, 0});
        WorldConfigurator configurator(room.world());
        configurator.apply({.restingBoxes = areDeclared});
        cube.forceActivationState(ISLAND_SLEEPING);
        cube.setWorldTransform(placeAt({40, 2, 0}));
        configurator.step(btScalar(1) / 64);
        const btVector3 from(40, 9, 0);
        const btVector3 to(40, 1, 0);
        btCollisionWorld::ClosestRayResultCallback hit(from, to);
        room.world().rayTest(from, to, hit);
        EXPECT_EQ(hit.hasHit(), areDeclared);
        room.world().updateSingleAabb(&cube);
        room.world().rayTest(from, to, hit);
        EXPECT_TRUE(hit.hasHit());
    }
}

TEST(WorldConfigurator, BelieveWhoChangesASettingMeanwhile) {
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

TEST(WorldConfigurator, FollowBodiesThatComeAndGo) {
    EffectsRoom room;
    btRigidBody& first = room.addCube({0, 2, 0});
    WorldConfigurator configurator(room.world());
    configurator.apply({.rotation = false});
    EXPECT_EQ(first.getAngularFactor(), btVector3(0, 0, 0));
    btRigidBody& second = room.addCube({5, 2, 0});
    EXPECT_EQ(second.getAngularFactor(), btVector3(1, 1, 1));
    configurator.prepare(second);
    EXPECT_EQ(second.getAngularFactor(), btVector3(0, 0, 0));
    EXPECT_EQ(configurator.heldCount(), 2U);
    configurator.release(second);
    EXPECT_EQ(second.getAngularFactor(), btVector3(1, 1, 1));
}

// As pools do, which nobody reminds of release().
TEST(WorldConfigurator, GiveBackWhatABodyHadThatWasAway) {
    for (const bool isPrepared : {true, false}) {
        EffectsRoom room;
        btRigidBody& pooled = room.addCube({0, 2, 0});
        pooled.setFriction(btScalar(0.7));
        WorldConfigurator configurator(room.world());
        configurator.apply({.sleeping = false, .rotation = false, .friction = false});
        room.world().removeRigidBody(&pooled);
        configurator.apply({});  // it is not in the world, and may be gone
        EXPECT_EQ(pooled.getFriction(), 0);
        pooled.setRollingFriction(btScalar(0.2));  // its own from now on
        room.world().addRigidBody(&pooled);
        if (isPrepared) {
            configurator.prepare(pooled);
        } else {
            configurator.apply({});
        }
        EXPECT_EQ(pooled.getFriction(), btScalar(0.7));
        EXPECT_EQ(pooled.getRollingFriction(), btScalar(0.2));
        EXPECT_EQ(pooled.getAngularFactor(), btVector3(1, 1, 1));
        EXPECT_EQ(pooled.getActivationState(), ACTIVE_TAG);
        EXPECT_EQ(configurator.heldCount(), 0U);
    }
}

/// Memory in which one body is made after another.
struct BodyPlace {
    btRigidBody& make(EffectsRoom& room) {
        auto* const body = new (memory.data()) btRigidBody(1, nullptr, &shape, {1, 1, 1});
        room.world().addRigidBody(body);
        return *body;
    }
    static void destroy(EffectsRoom& room, btRigidBody& body) {
        room.world().removeRigidBody(&body);
        body.~btRigidBody();
    }
    btSphereShape shape{1};
    alignas(btRigidBody) std::array<std::byte, sizeof(btRigidBody)> memory;
};

TEST(WorldConfigurator, TakeABodyMadeWhereAnotherWasForWhatItIs) {
    BodyPlace place;
    EffectsRoom room;
    WorldConfigurator configurator(room.world());
    for (const auto friction : {btScalar(0.7), btScalar(0.2)}) {
        btRigidBody& body = place.make(room);
        body.setFriction(friction);
        configurator.apply({.friction = false});
        EXPECT_EQ(body.getFriction(), 0);
        if (friction < btScalar(0.5)) {
            configurator.apply({});
            EXPECT_EQ(body.getFriction(), friction);
        }
        BodyPlace::destroy(room, body);
    }
}

// Some of what is set is what Bullet sets by itself.
TEST(WorldConfigurator, TakeABodyMadeAfterAnotherThatWasNeverReleasedForANewOne) {
    BodyPlace place;
    EffectsRoom room;
    WorldConfigurator configurator(room.world());
    configurator.apply({.sweep = false, .friction = false});
    for (const bool isFirst : {true, false}) {
        btRigidBody& body = place.make(room);
        if (isFirst) {
            body.setRollingFriction(btScalar(0.1));
            body.setCcdMotionThreshold(btScalar(0.5));
        }
        configurator.prepare(body);
        EXPECT_EQ(body.getFriction(), 0);
        if (!isFirst) {
            configurator.apply({});
            EXPECT_EQ(body.getFriction(), btScalar(0.5));
            EXPECT_EQ(body.getRollingFriction(), 0);
            EXPECT_EQ(body.getCcdMotionThreshold(), 0);
        }
        BodyPlace::destroy(room, body);
        configurator.apply(configurator.effects());
    }
}

TEST(WorldConfigurator, LeaveSoftBodiesAlone) {
    struct Soft : btCollisionObject {
        Soft() { m_internalType = CO_SOFT_BODY; }
    } soft;
    btSphereShape shape(1);
    soft.setCollisionShape(&shape);
    EffectsRoom room;
    room.world().addCollisionObject(&soft);
    const int flags = soft.getCollisionFlags();
    {
        WorldConfigurator configurator(room.world());
        configurator.apply({.response = false, .rotation = false, .friction = false});
        EXPECT_EQ(soft.getCollisionFlags(), flags);
    }
    room.world().removeCollisionObject(&soft);
}

TEST(WorldConfigurator, FileBodiesThatRestOnce) {
    EffectsRoom room;
    btRigidBody& floor = room.body(0);
    WorldConfigurator configurator(room.world());
    configurator.apply({.restingBoxes = false});
    const auto top = [&] { return floor.getBroadphaseProxy()->m_aabbMax.y(); };
    EXPECT_EQ(top(), gContactBreakingThreshold) << "with the margin that Bullet adds in a step";
    floor.setWorldTransform(placeAt({0, 4, 0}));
    run(configurator, 1);
    EXPECT_EQ(top(), gContactBreakingThreshold);
    room.world().updateSingleAabb(&floor);
    EXPECT_GT(top(), 5);
}

TEST(WorldConfigurator, AreNotAppliedByTheirOwnFunction) {
    EffectsRoom room;
    room.addCube({0, btScalar(0.5), 0});
    WorldConfigurator configurator(room.world());
    const CaughtAsserts caught;
    int calls = 0;
    configurator.apply({.effectsOf = [&, large = std::array<int, 16>{}](const btCollisionObject&) {
        configurator.apply({.pairs = false});
        calls += 1 + large[0];
        return BodyEffects{};
    }});
    run(configurator, 2);
    EXPECT_GT(calls, 2);
    EXPECT_EQ(caught.count(), HASHPHASE_ENABLE_ASSERTS ? calls : 0);
    EXPECT_EQ(room.cost().pairCount, 1U);
}

// Bullet puts the last object where the one was that goes. From the contact of bodies 3 and 4 on, 7 and 8 are where
// 1 and 2 were.
TEST(WorldConfigurator, ReachAllBodiesThoughCallbacksRemoveSome) {
    PairCache cache;
    EffectsRoom room(std::make_unique<btDbvtBroadphase>(&cache));
    for (int i = 0; i < 8; ++i) {
        room.addCube({btScalar(i) * btScalar(0.9), btScalar(0.5), 0});
    }
    room.step();
    WorldConfigurator configurator(room.world());
    static DynamicsWorld* where;
    static int removed;
    where = &room;
    removed = 0;
    gContactEndedCallback = [](btPersistentManifold* const& manifold) {
        const int product =
            manifold->getBody0()->getUserIndex() * manifold->getBody1()->getUserIndex();
        if (product == 3 * 4 && removed == 0) {
            removed = 2;
            where->takeOut(1);
            where->takeOut(2);
        }
    };
    configurator.apply({.effectsOf = [](const btCollisionObject& object) {
        return BodyEffects{.pairs = object.isStaticObject()};
    }});
    gContactEndedCallback = nullptr;
    EXPECT_EQ(removed, 2);
    EXPECT_EQ(room.cost().pairCount, 0U);
}

TEST(WorldConfigurator, KeepTheFilterThatTheWorldHad) {
    FilterBy refuse(false);
    EffectsRoom room;
    room.addCube({0, btScalar(0.5), 0});
    room.cache().setOverlapFilterCallback(&refuse);
    WorldConfigurator configurator(room.world());
    configurator.apply({.effectsOf = [](const btCollisionObject&) { return BodyEffects(); }});
    run(configurator, 2);
    EXPECT_EQ(room.cost().pairCount, 0);
    configurator.apply({});
    EXPECT_EQ(room.cache().getOverlapFilterCallback(), &refuse);
    room.cache().setOverlapFilterCallback(nullptr);
}

/// A room that has no pairs, and is then to have them without rotation and friction.
struct AppliedOutOfMemory {
    AppliedOutOfMemory() {
        fillWithSettings(room);
        own = settingsOf(room);
        configurator.apply({.pairs = false});
        room.world().computeOverlappingPairs();
    }
    void apply() { configurator.apply({.rotation = false, .friction = false}); }

    EffectsRoom room;
    std::vector<btScalar> own;
    WorldConfigurator configurator{room.world()};
};

TEST(WorldConfigurator, AppliesAgainWhatItHadNoMemoryFor) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    AppliedOutOfMemory whole;
    whole.apply();
    whole.room.world().computeOverlappingPairs();
    const std::size_t failureCount =
        runOutOfMemory([] { return std::make_unique<AppliedOutOfMemory>(); },
                       [](AppliedOutOfMemory& world) { world.apply(); },
                       [&](AppliedOutOfMemory& world, std::size_t) {
                           world.apply();
                           // Brings the cache up to date.
                           world.room.world().computeOverlappingPairs();
                           EXPECT_EQ(settingsOf(world.room), settingsOf(whole.room));
                           EXPECT_EQ(world.room.cost().pairCount, whole.room.cost().pairCount);
                           world.configurator.apply({});
                           EXPECT_EQ(settingsOf(world.room), world.own);
                       });
    EXPECT_GE(failureCount, 5U);
}

}  // namespace
}  // namespace hashphase::test
