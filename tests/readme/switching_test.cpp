// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/switching.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace before {
#include <switching_1.inl>
}  // namespace before
namespace after {
#include <switching_2.inl>
}  // namespace after

namespace {

std::string printedBy(int (*program)()) {
    testing::internal::CaptureStdout();
    const int status = program();
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, 0);
    return printed;
}

TEST(Switching, ProgramPrintsTheSameBeforeAndAfter) {
    const btScalar margin = gDbvtMargin;
    const std::string printed = printedBy(&before::main);
    gDbvtMargin = margin;
    EXPECT_EQ(printed, "the ball lies at 4.1 m\nthe ball lies at 1.0 m\n2 seen\n");
    EXPECT_EQ(printedBy(&after::main), printed);
}

TEST(Switching, EagerGroupsGetTheirPairsAtOnce) {
    constexpr int kTriggerGroup = 64;
#include <switching_3.inl>
    for (const int group : {int{btBroadphaseProxy::SensorTrigger}, int{kTriggerGroup}}) {
        EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, group, -1, nullptr);
    }
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
}

TEST(Switching, RefilteringRemovesAPairAtOnce) {
    constexpr int kEnemyGroup = 64;
    SpatialHashBroadphase broadphase;
    FallingSphere sphere;
    btRigidBody& body = sphere.body;
    btDispatcher& dispatcher = sphere.dispatcher;
    broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, kEnemyGroup, -1, nullptr);
    body.setBroadphaseHandle(
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr));
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
    {
#include <switching_4.inl>
    } EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST(Switching, ChangedShapesKeepTheirPairsButNoAlgorithm) {
    FallingSphere sphere;
    btSphereShape larger(2);
    btCollisionObject other;
    other.setCollisionShape(&sphere.shape);
    SpatialHashBroadphase broadphase;
    btRigidBody& body = sphere.body;
    btDispatcher& dispatcher = sphere.dispatcher;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &sphere.solver, &sphere.configuration);
    world.addRigidBody(&body);
    world.addCollisionObject(&other);
    world.performDiscreteCollisionDetection();
    btBroadphasePair* pair =
        world.getPairCache()->findPair(body.getBroadphaseProxy(), other.getBroadphaseHandle());
    ASSERT_NE(pair, nullptr);
    ASSERT_NE(pair->m_algorithm, nullptr);
#include <switching_5.inl>
    EXPECT_EQ(pair->m_algorithm, nullptr);
    EXPECT_EQ(world.getPairCache()->getNumOverlappingPairs(), 1);
    world.removeCollisionObject(&other);
    world.removeRigidBody(&body);
}

TEST(Switching, ClosestRayFindsWhatTheWorldFinds) {
    FallingSphere sphere;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world(&sphere.dispatcher, &broadphase, &sphere.solver,
                                  &sphere.configuration);
    world.addRigidBody(&sphere.body);
    const btVector3 from(0, 9, 0);
    const btVector3 to(0, -9, 0);
    btCollisionWorld::ClosestRayResultCallback expected(from, to);
    world.rayTest(from, to, expected);
#include <switching_6.inl>
    EXPECT_TRUE(hit.hasHit());
    EXPECT_EQ(hit.m_closestHitFraction, expected.m_closestHitFraction);
    world.removeRigidBody(&sphere.body);
}

TEST(Switching, PairCacheWorksUnderBulletsBroadphase) {
#include <switching_7.inl>
    for (int i = 0; i < 2; ++i) {
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
    }
    EXPECT_EQ(pairCache.getNumOverlappingPairs(), 1);
}

}  // namespace
}  // namespace hashphase::test
