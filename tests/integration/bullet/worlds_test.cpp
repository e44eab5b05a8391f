// SPDX-License-Identifier: Zlib
//
// The broadphase in the hands of a world: who frees what, in which order, and callbacks of a world that
// remove bodies from it.

#include <tests/integration/bullet/dynamics.hpp>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <LinearMath/btPoolAllocator.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// A full world, of which tests choose what goes first. Objects go last.
struct Parts {
    btGhostPairCallback ghostCallback;
    btSphereShape shape{1};
    std::vector<std::unique_ptr<btCollisionObject>> objects;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::unique_ptr<btBroadphaseInterface> broadphase = makeBroadphase<SpatialHashBroadphase>();
    std::unique_ptr<btCollisionWorld> world =
        std::make_unique<btCollisionWorld>(&dispatcher, broadphase.get(), &configuration);

    Parts() {
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
    [[nodiscard]] int pairCount() const { return world->getPairCache()->getNumOverlappingPairs(); }
    [[nodiscard]] int algorithmCount() {
        return configuration.getCollisionAlgorithmPool()->getUsedCount();
    }
};

TEST(Worlds, MayBeDestroyedFullBeforeTheirBroadphase) {
    Parts parts;
    EXPECT_GT(parts.dispatcher.getNumManifolds(), 0);
    parts.world.reset();
    EXPECT_EQ(parts.broadphase->getOverlappingPairCache()->getNumOverlappingPairs(), 0);
    EXPECT_EQ(parts.dispatcher.getNumManifolds(), 0);
    parts.broadphase.reset();
}

TEST(Worlds, MayBeDestroyedEmptyAfterTheirBroadphase) {
    Parts parts;
    for (const auto& object : parts.objects) {
        parts.world->removeCollisionObject(object.get());
    }
    parts.broadphase.reset();
    parts.world.reset();
}

TEST(Worlds, FreeEveryAlgorithmWithItsPair) {
    Parts parts;
    const int pairCount = parts.pairCount();
    EXPECT_GT(pairCount, 20);
    EXPECT_EQ(parts.algorithmCount(), pairCount);
    // Apart: pairs die in calculateOverlappingPairs.
    for (int i = 0; i < 10; ++i) {
        parts.objects[static_cast<std::size_t>(i)]->setWorldTransform(
            placeAt({btScalar(i * 5), 50, 0}));
    }
    parts.world->performDiscreteCollisionDetection();
    EXPECT_LT(parts.algorithmCount(), pairCount);
    EXPECT_EQ(parts.algorithmCount(), parts.pairCount());
    for (const auto& object : parts.objects) {
        parts.world->removeCollisionObject(object.get());
        EXPECT_EQ(parts.algorithmCount(), parts.pairCount());
    }
    EXPECT_EQ(parts.algorithmCount(), 0);
    EXPECT_EQ(parts.dispatcher.getNumManifolds(), 0);
}

TEST(Worlds, GiveARefreshedObjectANewProxyWithTheSamePairs) {
    Parts parts;
    btCollisionObject* const object = parts.objects[7].get();
    const int pairCount = parts.pairCount();
    EXPECT_EQ(object->getBroadphaseHandle()->getUid(), 8);
    parts.world->refreshBroadphaseProxy(object);
    EXPECT_EQ(object->getBroadphaseHandle()->getUid(), 21);
    parts.world->performDiscreteCollisionDetection();
    EXPECT_EQ(parts.pairCount(), pairCount);
}

// A body whose box is too large, or NaN, is taken out of the simulation by Bullet.
TEST(Worlds, GoOnAroundABodyThatIsNotANumber) {
    DynamicsWorld scene;
    buildPile(scene);
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    scene.body(3).setLinearVelocity({nan, 0, 0});
    scene.step(60);
    for (int i = 4; i < scene.bodyCount(); ++i) {
        ASSERT_TRUE(scene.body(i).getWorldTransform().getOrigin().length() < 100) << "body " << i;
    }
    EXPECT_EQ(scene.hash().validate(), "");
}

TEST(Worlds, RunOverEveryPairCacheOfBullet) {
    for (const auto make : {kCacheKinds[3].make, kCacheKinds[4].make, makeCache<btNullPairCache>}) {
        const std::unique_ptr<btOverlappingPairCache> cache = make();
        const bool hasPairs = make != makeCache<btNullPairCache>;
        DynamicsWorld scene(hashOver(cache.get()));
        buildPile(scene);
        for (int step = 0; step < 90; ++step) {
            churn(scene, step);
            scene.step();
        }
        EXPECT_EQ(scene.dispatcher().getNumManifolds() > 0, hasPairs);
        EXPECT_EQ(scene.body(9).getWorldTransform().getOrigin().y() < -1, !hasPairs)
            << "Without pairs everything falls for ever.";
    }
}

TEST(Worlds, OfBtDbvtBroadphaseMoveAlikeOverOurPairCacheAndBullets) {
    btSphereShape large(3);
    std::vector<std::unique_ptr<DynamicsWorld>> worlds;
    std::vector<btPairCachingGhostObject*> ghosts;
    for (const std::size_t kind : {1U, 3U}) {
        std::unique_ptr<btOverlappingPairCache> cache = kCacheKinds[kind].make();
        btOverlappingPairCache* const given = cache.get();
        worlds.push_back(std::make_unique<DynamicsWorld>(std::make_unique<btDbvtBroadphase>(given),
                                                         std::move(cache)));
        buildPile(*worlds.back());
        ghosts.push_back(&worlds.back()->addGhost(&large, {0, 1, 0}));
    }
    for (int step = 0; step < 200; ++step) {
        for (const auto& world : worlds) {
            churn(*world, step);
            world->step();
        }
        ASSERT_EQ(uidList(worlds[0]->cache()), uidList(worlds[1]->cache())) << step;
        ASSERT_EQ(ghosts[0]->getNumOverlappingObjects(), ghosts[1]->getNumOverlappingObjects());
        ASSERT_EQ(firstDifferentBody(*worlds[0], *worlds[1]), -1) << step;
        ASSERT_EQ(dynamic_cast<PairCache&>(worlds[0]->cache()).validate(), "") << step;
    }
    EXPECT_GT(worlds[0]->pairCount(), 300);
    EXPECT_GT(ghosts[0]->getNumOverlappingObjects(), 10);
}

// As in tests/integration/bullet/hard_worlds_test.cpp, where nobody comes or goes.
TEST(Worlds, FromWhichBodiesAreTakenOutMoveAsUnderBtSimpleBroadphaseToTheLastBit) {
    const auto hash = canonicalWorld(hashOverPairCache);
    const auto simple =
        canonicalWorld([](PairCache* cache) -> std::unique_ptr<btBroadphaseInterface> {
            return std::make_unique<btSimpleBroadphase>(1000, cache);
        });
    buildPile(*hash);
    buildPile(*simple);
    for (int step = 0; step < 900; ++step) {
        for (DynamicsWorld* const world : {hash.get(), simple.get()}) {
            churn(*world, step);
            world->step();
        }
        ASSERT_EQ(firstDifferentBody(*hash, *simple), -1) << "after step " << step;
    }
    EXPECT_GT(hash->sleepingCount(), 0);
}

// --- Callbacks of a world ------------------------------------------------------------------------

/// Boxes that fall on a floor.
struct FallingBoxes : DynamicsWorld {
    explicit FallingBoxes(int count) {
        addBox({50, 10, 50}, 0, {0, -10, 0});
        for (int i = 0; i < count; ++i) {
            addBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1,
                   {btScalar(i % 5) * btScalar(0.9), btScalar(1 + i / 5), 0});
        }
        current = this;
    }
    void remove(btCollisionObject* object) { world().removeRigidBody(btRigidBody::upcast(object)); }
    void stepThrough(int count) {
        for (int i = 0; i < count; ++i) {
            step();
            EXPECT_EQ(hash().grid().validate(), "");
        }
    }
    [[nodiscard]] int objectCount() { return world().getNumCollisionObjects(); }

    static inline FallingBoxes* current = nullptr;  // of callbacks without a pointer of the user's
};

TEST(WorldCallbacks, OfTicksMayRemoveBodies) {
    for (const bool isBefore : {false, true}) {
        FallingBoxes boxes(30);
        boxes.world().setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                FallingBoxes::current->remove(
                    world->getCollisionObjectArray()[world->getNumCollisionObjects() - 1]);
            },
            nullptr, isBefore);
        boxes.stepThrough(20);
        EXPECT_EQ(boxes.objectCount(), 31 - 20);
        boxes.world().setInternalTickCallback(nullptr, nullptr, isBefore);
        boxes.step();
        EXPECT_EQ(boxes.hash().validate(), "");
    }
}

TEST(WorldCallbacks, OfTheDispatcherMayRemoveBodiesWhenItIsDoneWithThem) {
    static int calls = 0;
    calls = 0;
    FallingBoxes boxes(40);
    boxes.dispatcher().setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                                          const btDispatcherInfo& info) {
        auto* const first = static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
        auto* const second = static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
        btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
        if (++calls % 9 == 0) {
            FallingBoxes::current->remove(first->isStaticObject() ? second : first);
        }
    });
    boxes.stepThrough(20);
    EXPECT_GT(calls, 100);
    EXPECT_LT(boxes.objectCount(), 35);
}

TEST(WorldCallbacks, OfAWorldsRayTestMayRemoveBodies) {
    struct Removing : btCollisionWorld::RayResultCallback {
        btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
            auto* const hit = const_cast<btCollisionObject*>(result.m_collisionObject);
            EXPECT_TRUE(removed.insert(hit).second) << "what was removed is hit";
            FallingBoxes::current->remove(hit);
            return 1;
        }
        std::set<btCollisionObject*> removed;
    };
    for (const bool isClosest : {false, true}) {
        FallingBoxes boxes(40);
        boxes.step();
        Removing removing;
        const btVector3 from(btScalar(0.1), 20, btScalar(0.1));
        const btVector3 to(btScalar(0.1), btScalar(0.6), btScalar(0.1));
        if (isClosest) {
            boxes.hash().closestRay(from, to, removing);
        } else {
            boxes.world().rayTest(from, to, removing);
        }
        EXPECT_GT(removing.removed.size(), 4U);
        for (int step = 0; step < 3; ++step) {
            boxes.step();
            EXPECT_EQ(boxes.hash().validate(), "");
        }
    }
}

}  // namespace
}  // namespace hashphase::test
