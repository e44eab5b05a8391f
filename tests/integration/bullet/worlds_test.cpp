// SPDX-License-Identifier: Zlib
//
// The broadphase in the hands of a btDiscreteDynamicsWorld: who frees what, in which order.

#include <tests/integration/bullet/dynamics.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <LinearMath/btPoolAllocator.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

btTransform placeAt(const btVector3& place) {
    return btTransform(btQuaternion(0, 0, 0, 1), place);
}

/// Everything a world needs, on the heap, so that tests choose what goes first. Objects go last.
struct Parts {
    btGhostPairCallback ghostCallback;
    btSphereShape shape{1};
    std::vector<std::unique_ptr<btCollisionObject>> objects;
    std::unique_ptr<btDefaultCollisionConfiguration> configuration =
        std::make_unique<btDefaultCollisionConfiguration>();
    std::unique_ptr<btCollisionDispatcher> dispatcher =
        std::make_unique<btCollisionDispatcher>(configuration.get());
    std::unique_ptr<btBroadphaseInterface> broadphase = std::make_unique<SpatialHashBroadphase>();
    std::unique_ptr<btCollisionWorld> world =
        std::make_unique<btCollisionWorld>(dispatcher.get(), broadphase.get(), configuration.get());

    void fill() {
        world->getPairCache()->setInternalGhostPairCallback(&ghostCallback);
        for (int i = 0; i < 20; ++i) {
            objects.push_back(i % 5 == 0 ? std::make_unique<btPairCachingGhostObject>()
                                         : std::make_unique<btCollisionObject>());
            objects.back()->setCollisionShape(&shape);
            objects.back()->setWorldTransform(placeAt({btScalar(i), 0, 0}));
            world->addCollisionObject(objects.back().get());
        }
        world->performDiscreteCollisionDetection();
    }

    int algorithmCount() const {
        return configuration->getCollisionAlgorithmPool()->getUsedCount();
    }
};

TEST(Worlds, MayBeDestroyedFullBeforeTheirBroadphase) {
    Parts parts;
    parts.fill();
    EXPECT_GT(parts.dispatcher->getNumManifolds(), 0);
    parts.world.reset();
    EXPECT_EQ(parts.broadphase->getOverlappingPairCache()->getNumOverlappingPairs(), 0);
    EXPECT_EQ(parts.dispatcher->getNumManifolds(), 0);
    parts.broadphase.reset();
}

TEST(Worlds, MayBeDestroyedEmptyAfterTheirBroadphase) {
    Parts parts;
    parts.fill();
    for (const auto& object : parts.objects) {
        parts.world->removeCollisionObject(object.get());
    }
    parts.broadphase.reset();
    parts.world.reset();
}

TEST(Worlds, FreeEveryAlgorithmWithItsPair) {
    Parts parts;
    parts.fill();
    const int pairCount = parts.world->getPairCache()->getNumOverlappingPairs();
    EXPECT_GT(pairCount, 20);
    EXPECT_EQ(parts.algorithmCount(), pairCount);
    // Apart: pairs die in calculateOverlappingPairs.
    for (int i = 0; i < 10; ++i) {
        parts.objects[static_cast<std::size_t>(i)]->setWorldTransform(
            placeAt({btScalar(i * 5), 50, 0}));
    }
    parts.world->performDiscreteCollisionDetection();
    EXPECT_LT(parts.algorithmCount(), pairCount);
    EXPECT_EQ(parts.algorithmCount(), parts.world->getPairCache()->getNumOverlappingPairs());
    for (const auto& object : parts.objects) {
        parts.world->removeCollisionObject(object.get());
        EXPECT_EQ(parts.algorithmCount(), parts.world->getPairCache()->getNumOverlappingPairs());
    }
    EXPECT_EQ(parts.algorithmCount(), 0);
    EXPECT_EQ(parts.dispatcher->getNumManifolds(), 0);
}

TEST(Worlds, GiveARefreshedObjectANewProxyWithTheSamePairs) {
    Parts parts;
    parts.fill();
    btCollisionObject* const object = parts.objects[7].get();
    const int pairCount = parts.world->getPairCache()->getNumOverlappingPairs();
    const int uniqueId = object->getBroadphaseHandle()->getUid();
    parts.world->refreshBroadphaseProxy(object);
    EXPECT_EQ(object->getBroadphaseHandle()->getUid(), 21);
    EXPECT_NE(object->getBroadphaseHandle()->getUid(), uniqueId);
    parts.world->performDiscreteCollisionDetection();
    EXPECT_EQ(parts.world->getPairCache()->getNumOverlappingPairs(), pairCount);
}

// A body whose box is too large, or NaN, is taken out of the simulation by Bullet.
TEST(Worlds, GoOnAroundABodyThatIsNotANumber) {
    DynamicsWorld scene(std::make_unique<SpatialHashBroadphase>());
    dynamicsScenes().front().build(scene);
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    scene.body(3).setLinearVelocity({nan, 0, 0});
    for (int step = 0; step < 60; ++step) {
        scene.step();
    }
    for (int i = 4; i < scene.bodyCount(); ++i) {
        const btVector3& place = scene.body(i).getWorldTransform().getOrigin();
        ASSERT_TRUE(place.length() < 100) << "body " << i;
    }
    EXPECT_EQ(dynamic_cast<SpatialHashBroadphase&>(scene.broadphase()).validate(), "");
}

TEST(Worlds, RunOverEveryPairCacheOfBullet) {
    for (int kind = 0; kind < 3; ++kind) {
        std::unique_ptr<btOverlappingPairCache> cache;
        if (kind == 0) {
            cache = std::make_unique<btHashedOverlappingPairCache>();
        } else if (kind == 1) {
            cache = std::make_unique<btSortedOverlappingPairCache>();
        } else {
            cache = std::make_unique<btNullPairCache>();
        }
        btOverlappingPairCache* const given = cache.get();
        DynamicsWorld scene(std::make_unique<SpatialHashBroadphase>(given), std::move(cache));
        dynamicsScenes()[4].build(scene);
        for (int step = 0; step < 90; ++step) {
            dynamicsScenes()[4].disturb(scene, step);
            scene.step();
        }
        EXPECT_EQ(scene.dispatcher().getNumManifolds() > 0, kind != 2);
        EXPECT_EQ(scene.body(9).getWorldTransform().getOrigin().y() < -1, kind == 2)
            << "Without pairs everything falls for ever.";
    }
}

}  // namespace
}  // namespace hashphase::test
