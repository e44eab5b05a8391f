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

TEST(Switching, CallsAfterChangesEndPairsAndFreeAlgorithms) {
    constexpr int kEnemyGroup = 64;
    FallingSphere sphere;
    btSphereShape larger(2);
    btCollisionObject other;
    btCollisionObject enemy;
    other.setCollisionShape(&sphere.shape);
    enemy.setCollisionShape(&sphere.shape);
    SpatialHashBroadphase broadphase;
    btRigidBody& body = sphere.body;
    btDispatcher& dispatcher = sphere.dispatcher;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &sphere.solver, &sphere.configuration);
    world.addRigidBody(&body);
    world.addCollisionObject(&other, btBroadphaseProxy::StaticFilter);
    world.addCollisionObject(&enemy, kEnemyGroup, btBroadphaseProxy::DefaultFilter);
    world.performDiscreteCollisionDetection();
    const auto pairWith = [&](btCollisionObject& object) {
        return world.getPairCache()->findPair(body.getBroadphaseProxy(),
                                              object.getBroadphaseHandle());
    };
    ASSERT_NE(pairWith(other), nullptr);
    ASSERT_NE(pairWith(other)->m_algorithm, nullptr);
    EXPECT_NE(pairWith(enemy), nullptr);
#include <switching_3.inl>
    EXPECT_EQ(pairWith(enemy), nullptr);
    ASSERT_NE(pairWith(other), nullptr);
    EXPECT_EQ(pairWith(other)->m_algorithm, nullptr);
    world.removeCollisionObject(&enemy);
    world.removeCollisionObject(&other);
    world.removeRigidBody(&body);
}

}  // namespace
}  // namespace hashphase::test
