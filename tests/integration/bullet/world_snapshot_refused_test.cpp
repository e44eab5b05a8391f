// SPDX-License-Identifier: Zlib

// What cannot be saved is refused by a sentence, and nothing has changed.

#include <integration/bullet/world_snapshot.hpp>

#include <integration/bullet/worlds_broadphase.hpp>
#include <tests/integration/bullet/callbacks.hpp>
#include <tests/integration/bullet/pool_world.hpp>

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <span>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

TEST(WorldSnapshot, RefusesACompoundShapeThatHasChanged) {
    FewBodies few;
    btCompoundShape inner;
    inner.addChildShape(btTransform::getIdentity(), &few.ball);
    btCompoundShape outer;
    outer.addChildShape(btTransform::getIdentity(), &inner);
    btRigidBody body(1, nullptr, &outer, btVector3(1, 1, 1));
    few.world.addRigidBody(&body);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    inner.addChildShape(btTransform::getIdentity(), &few.box);
    EXPECT_EQ(few.restoreWithout(snapshot),
              "Object 7 (unique id 8) has a compound shape that changed after it was saved. Save "
              "again after such a change.");
    few.world.removeRigidBody(&body);
}

TEST(WorldSnapshot, RefusesWhatItDoesNotCover) {
    WorldSnapshot snapshot;
    FewBodies few;
    SpatialHashBroadphase other;
    EXPECT_EQ(snapshot.save(few.world, other),
              "The world has another broadphase. Pass the broadphase of the world.");
    EXPECT_EQ(snapshot.restore(few.world, few.broadphase),
              "WorldSnapshot::restore(): the snapshot is empty. Call save() or read() first.");

    btRaycastVehicle::btVehicleTuning tuning;
    btDefaultVehicleRaycaster caster(&few.world);
    btRaycastVehicle vehicle(tuning, few.pool[0].get(), &caster);
    few.world.addAction(&vehicle);
    EXPECT_EQ(few.save(snapshot),
              "Action 0 of the world is not a btKinematicCharacterController, but a vehicle or "
              "another action, which a snapshot cannot keep. Remove it first.");
    few.world.removeAction(&vehicle);

    few.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0).m_userPersistentData = &few;
    EXPECT_EQ(few.save(snapshot),
              "A contact point has user data (m_userPersistentData), which a snapshot cannot keep. "
              "Keep that data elsewhere.");
    few.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0).m_userPersistentData = nullptr;
    EXPECT_TRUE(snapshot.isEmpty());

    btPersistentManifold* const own = few.dispatcher.getNewManifold(&few.floor, &few.floor);
    EXPECT_NE(few.save(snapshot).find("1 belong to no pair of the world"), std::string::npos);
    few.dispatcher.releaseManifold(own);

    EXPECT_EQ(few.save(snapshot), "");
    btCollisionObject stranger;
    stranger.setCollisionShape(&few.ball);
    few.world.addCollisionObject(&stranger);
    struct Type : btCollisionObject {
        static void set(btCollisionObject& object, int type) {
            object.*(&Type::m_internalType) = type;
        }
    };
    Type::set(stranger, btCollisionObject::CO_SOFT_BODY);
    EXPECT_EQ(
        few.save(snapshot),
        "Object 7 of the world is a soft body, which a snapshot cannot keep. Remove it first.");
    Type::set(stranger, btCollisionObject::CO_FEATHERSTONE_LINK);
    EXPECT_EQ(few.save(snapshot),
              "Object 7 of the world is a link of a multibody, which a snapshot cannot keep. "
              "Remove it first.");
    Type::set(stranger, btCollisionObject::CO_COLLISION_OBJECT);
    EXPECT_EQ(few.save(snapshot), "");
    few.world.removeCollisionObject(&stranger);
}

TEST(WorldSnapshot, RefusesOtherPairCachesSolversAndMultibodies) {
    WorldSnapshot snapshot;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    {
        btHashedOverlappingPairCache cache;
        SpatialHashBroadphase broadphase(&cache);
        btSequentialImpulseConstraintSolver solver;
        btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
        EXPECT_EQ(snapshot.save(world, broadphase),
                  "The broadphase's pair cache is not a hashphase::PairCache, which a snapshot "
                  "needs. Make the broadphase with one.");
    }
    {
        struct OwnSolver : btConstraintSolver {
            btScalar solveGroup(btCollisionObject**, int, btPersistentManifold**, int,
                                btTypedConstraint**, int, const btContactSolverInfo&, btIDebugDraw*,
                                btDispatcher*) override {
                return 0;
            }
            void reset() override {}
            [[nodiscard]] btConstraintSolverType getSolverType() const override {
                return BT_SEQUENTIAL_IMPULSE_SOLVER;
            }
        } solver;
        SpatialHashBroadphase broadphase;
        btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
        EXPECT_EQ(snapshot.save(world, broadphase),
                  "The world's solver is not a btSequentialImpulseConstraintSolver, which a "
                  "snapshot needs. Make the world with one.");
    }
    SpatialHashBroadphase broadphase;
    btMultiBodyConstraintSolver solver;
    btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    EXPECT_EQ(snapshot.save(world, broadphase), "");
    btMultiBody body(0, 1, btVector3(1, 1, 1), false, false);
    body.finalizeMultiDof();
    world.addMultiBody(&body);
    EXPECT_EQ(snapshot.save(world, broadphase),
              "The world has multibodies, which a snapshot cannot keep. Remove them first.");
    world.removeMultiBody(&body);
}

// Their algorithms are of children that may be gone.
TEST(WorldSnapshot, RefusesCompoundsThatHaveChangedSinceTheStep) {
    FewBodies few;
    btCompoundShape compound;
    for (int i = 0; i < 4; ++i) {
        compound.addChildShape(
            btTransform(btQuaternion(0, 0, 0, 1), btVector3(btScalar(i) / 4, 0, 0)), &few.ball);
    }
    btRigidBody body(1, nullptr, &compound, btVector3(1, 1, 1));
    btRigidBody twin(1, nullptr, &compound, btVector3(1, 1, 1));
    for (btRigidBody* each : {&body, &twin}) {
        each->setCenterOfMassTransform(
            btTransform(btQuaternion(0, 0, 0, 1), btVector3(0, btScalar(0.4), 0)));
        few.world.addRigidBody(each);
    }
    few.world.stepSimulation(btScalar(1) / 60, 0);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    compound.removeChildShapeByIndex(3);
    EXPECT_NE(few.save(snapshot).find("A compound shape changed after the last step"),
              std::string::npos);
    EXPECT_TRUE(snapshot.isEmpty());
    for (btRigidBody* each : {&body, &twin}) {
        few.broadphase.shapeChanged(each->getBroadphaseHandle(), &few.dispatcher);
    }
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    EXPECT_EQ(wholeState(few.world), state);
    few.world.removeRigidBody(&body);
    few.world.removeRigidBody(&twin);
}

/// Bullet's, but for its class.
struct OwnAlgorithm final : btConvexConvexAlgorithm {
    using btConvexConvexAlgorithm::btConvexConvexAlgorithm;

    struct Create final : btCollisionAlgorithmCreateFunc {
        btGjkEpaPenetrationDepthSolver* depths = nullptr;
        btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                       const btCollisionObjectWrapper* a,
                                                       const btCollisionObjectWrapper* b) override {
            void* const memory =
                info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(OwnAlgorithm));
            return new (memory) OwnAlgorithm(info.m_manifold, info, a, b, depths, 0, 0);
        }
    };
};

TEST(WorldSnapshot, RefusesAlgorithmsOfTheProgram) {
    btGjkEpaPenetrationDepthSolver depths;
    OwnAlgorithm::Create create;
    create.depths = &depths;
    PoolWorld pool;
    pool.dispatcher.registerCollisionCreateFunc(CAPSULE_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE,
                                                &create);
    pool.dispatcher.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE,
                                                &create);
    pool.add(1, btVector3(0, 1, 0));
    pool.add(2, btVector3(0, btScalar(1.2), 0));
    pool.world.stepSimulation(btScalar(1) / 60, 0);
    WorldSnapshot snapshot;
    EXPECT_EQ(pool.save(snapshot),
              "A pair has a collision algorithm that a snapshot cannot keep. Use Bullet's default "
              "algorithms only.");
    EXPECT_TRUE(snapshot.isEmpty());
}

TEST(WorldSnapshot, RefusesOneOfManyWorlds) {
    WorldsConfig config;
    config.worldCount = 2;
    config.worldOf = [](const btCollisionObject& /*object*/) { return 0; };
    WorldsBroadphase worlds(config);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &worlds.world(0), &solver, &configuration);
    WorldSnapshot snapshot;
    EXPECT_EQ(snapshot.save(world, worlds.world(0)),
              "The broadphase is a world of a WorldsBroadphase, which snapshots do not support. "
              "Use a SpatialHashBroadphase for the world.");
}

void expectRefusalsWithinCallbacks(const std::vector<std::string>& faults) {
    EXPECT_FALSE(faults.empty());
    for (const std::string& fault : faults) {
        EXPECT_EQ(fault,
                  "The snapshot was used from a callback of the broadphase or of its pair cache. "
                  "Use it between steps.");
    }
}

// Between calculations: a proxy goes, a shape changes, the program removes and adds pairs.
TEST(WorldSnapshot, RefusesCallsWithinGhostCallbacks) {
    using Change = std::function<void(FewBodies&, const btBroadphasePair&)>;
    const std::array<Change, 5> changes{
        [](FewBodies& few, const btBroadphasePair& pair) {
            few.world.refreshBroadphaseProxy(
                static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject));
        },
        [](FewBodies& few, const btBroadphasePair& pair) {
            few.broadphase.shapeChanged(pair.m_pProxy0, &few.dispatcher);
        },
        [](FewBodies& few, const btBroadphasePair& pair) {
            few.cache.removeOverlappingPairsContainingProxies(std::span(&pair.m_pProxy0, 1),
                                                              &few.dispatcher);
        },
        [](FewBodies& few, const btBroadphasePair& pair) {
            few.cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &few.dispatcher);
        },
        [](FewBodies& few, const btBroadphasePair& pair) {
            few.cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &few.dispatcher);
            few.cache.addOverlappingPair(pair.m_pProxy0, pair.m_pProxy1);
        }};
    for (const Change& change : changes) {
        FewBodies few;
        ASSERT_GT(few.cache.getNumOverlappingPairs(), 0);
        const btBroadphasePair pair = few.cache.getOverlappingPairArray()[0];
        WorldSnapshot snapshot;
        std::vector<std::string> faults;
        PairJournal journal;
        journal.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
            faults.push_back(few.save(snapshot));
        };
        journal.onDeath = journal.onBirth;
        few.cache.setInternalGhostPairCallback(&journal);
        change(few, pair);
        few.cache.setInternalGhostPairCallback(nullptr);
        expectRefusalsWithinCallbacks(faults);
        EXPECT_EQ(few.save(snapshot), "");
    }
}

TEST(WorldSnapshot, RefusesCallsWithinCallbacksOfContactsThatEnd) {
    static FewBodies* where;
    static std::vector<std::string>* noted;
    FewBodies few;
    std::vector<std::string> faults;
    where = &few;
    noted = &faults;
    gContactEndedCallback = [](btPersistentManifold* const& /*manifold*/) {
        WorldSnapshot snapshot;
        noted->push_back(where->save(snapshot));
    };
    const btCollisionObjectArray& objects = few.world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        few.cache.cleanProxyFromPairs(objects[i]->getBroadphaseHandle(), &few.dispatcher);
    }
    gContactEndedCallback = nullptr;
    expectRefusalsWithinCallbacks(faults);
}

TEST(WorldSnapshot, RefusesToBeRestoredByACallbackWhileItIsRestored) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    for (const std::size_t added : {6U, 7U, 8U}) {
        few.add(added, few.pool[0]->getWorldTransform().getOrigin());
    }
    few.world.stepSimulation(btScalar(1) / 60, 0);
    std::vector<std::string> faults;
    PairJournal journal;
    journal.onDeath = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        faults.push_back(few.restoreWithout(snapshot));
    };
    few.cache.setInternalGhostPairCallback(&journal);
    EXPECT_EQ(few.restoreWithout(snapshot), "");
    few.cache.setInternalGhostPairCallback(nullptr);
    expectRefusalsWithinCallbacks(faults);
    EXPECT_EQ(wholeState(few.world), state);
}

TEST(WorldSnapshot, IsNotWrittenWhereSomethingIsNotInTheWorld) {
    FewBodies few;
    btPoint2PointConstraint joint(*few.pool[0], *few.pool[9], btVector3(0, 1, 0),
                                  btVector3(0, -1, 0));
    few.world.addConstraint(&joint);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    std::vector<std::byte> bytes(3);
    EXPECT_NE(snapshot.write(bytes).find("a body of a joint"), std::string::npos);
    EXPECT_TRUE(bytes.empty());
}

}  // namespace
}  // namespace hashphase::test
