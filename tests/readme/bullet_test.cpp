// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/bullet.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

/// A world with one sphere at the origin.
class BulletPage : public testing::Test {
protected:
    BulletPage() { world.addRigidBody(&sphere.body); }
    ~BulletPage() override { world.removeRigidBody(&sphere.body); }

    FallingSphere sphere;
    btRigidBody& body = sphere.body;
    btDispatcher* dispatcher = &sphere.dispatcher;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world{dispatcher, &broadphase, &sphere.solver, &sphere.configuration};
};

TEST(BulletPageAlone, SettingsAreTaken) {
#include <bullet_1.inl>
    EXPECT_NE(broadphase.sweeps(), nullptr);
}

TEST_F(BulletPage, ThousandAreCreatedAndDestroyed) {
    const std::size_t size = broadphase.grid().size();
#include <bullet_2.inl>
    EXPECT_EQ(broadphase.grid().size(), size);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST_F(BulletPage, RaysFindTheSphere) {
    const btVector3 from(0, 9, 0);
    const btVector3 to(0, -9, 0);
    std::vector<btCollisionWorld::ClosestRayResultCallback> callbacks;
    callbacks.emplace_back(from, to);
    callbacks.emplace_back(to, from);
#include <bullet_3.inl>
    EXPECT_TRUE(hit.hasHit());
    EXPECT_TRUE(callbacks[0].hasHit() && callbacks[1].hasHit());
}

TEST_F(BulletPage, IdsLeadToObjectsAndBack) {
#include <bullet_4.inl>
    EXPECT_EQ(object, &body);
}

TEST_F(BulletPage, GroupsGoAlong) {
    const int kEnemyGroup = btBroadphaseProxy::DefaultFilter;
    const btVector3 position(0, 20, 0);
#include <bullet_5.inl>
    EXPECT_EQ(found, std::vector{SpatialHashBroadphase::idOf(body.getBroadphaseProxy())});
}

TEST_F(BulletPage, PairsAreIgnored) {
    FallingSphere another;
    btRigidBody& other = another.body;
    world.addRigidBody(&other);
    world.performDiscreteCollisionDetection();
    btBroadphaseProxy* const rider = body.getBroadphaseProxy();
    btBroadphaseProxy* const horse = other.getBroadphaseProxy();
    const auto isPair = [&] {
        return broadphase.getOverlappingPairCache()->findPair(rider, horse) != nullptr;
    };
    EXPECT_TRUE(isPair());
    {
#include <bullet_6.inl>
    } EXPECT_FALSE(isPair());
    world.removeRigidBody(&other);
}

struct NearestPoint : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
        found.push_back(point.getDistance());
        return 0;
    }
    static inline std::vector<btScalar> found;
};

TEST_F(BulletPage, MarginsFindWhatIsNear) {
    FallingSphere another;
    another.body.setCenterOfMassTransform(
        btTransform(btQuaternion(0, 0, 0, 1), {btScalar(2.125), 0, 0}));
    world.addRigidBody(&another.body);
    world.performDiscreteCollisionDetection();
    btBroadphaseProxy* const gripper = body.getBroadphaseProxy();
    btOverlappingPairCache& cache = *broadphase.getOverlappingPairCache();
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
    NearestPoint::found.clear();
    const std::vector<btBroadphasePair> neighbours{{*gripper, *another.body.getBroadphaseProxy()}};
#include <bullet_7.inl>
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
    EXPECT_EQ(NearestPoint::found, std::vector{btScalar(0.125)});
    world.removeRigidBody(&another.body);
}

TEST_F(BulletPage, EmptyWorldIsReset) {
    world.removeRigidBody(&body);
#include <bullet_8.inl>
    world.addRigidBody(&body);
    EXPECT_EQ(body.getBroadphaseProxy()->getUid(), 1);
}

TEST_F(BulletPage, OriginIsShifted) {
    btVector3 myCamera(0, 2, 0);
#include <bullet_9.inl>
    EXPECT_EQ(body.getWorldTransform().getOrigin().x(), -1024);
    EXPECT_EQ(myCamera, btVector3(-1024, 2, 0));
}

TEST(BulletPageAlone, CacheOfYoursIsUsed) {
#include <bullet_10.inl>
    EXPECT_EQ(broadphase.getOverlappingPairCache(), &pairCache);
}

TEST(BulletPageAlone, WorldsAreOneWorldOfBullets) {
    FallingSphere sphere;
    btDispatcher* const dispatcher = &sphere.dispatcher;
    btConstraintSolver* const solver = &sphere.solver;
    btCollisionConfiguration* const configuration = &sphere.configuration;
    std::deque<btRigidBody> robots;
    for (int i = 0; i < 300; ++i) {
        robots.emplace_back(1, nullptr, sphere.body.getCollisionShape());
    }
    const btVector3 from(0, 9, 0);
    const btVector3 to(0, -9, 0);
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
#include <bullet_11.inl>
    EXPECT_EQ(hit.m_collisionObject, &robots[7]);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
    world.performDiscreteCollisionDetection();
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
    for (btRigidBody& robot : robots) {
        world.removeRigidBody(&robot);
    }
}

}  // namespace
}  // namespace hashphase::test
