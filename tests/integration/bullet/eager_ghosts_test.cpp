// SPDX-License-Identifier: Zlib
//
// Ghosts and characters have their pairs at once, by what they are; groups mean nothing.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/integration/bullet/pair_journal.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

/// A character that walks between pillars.
struct Walk {
    SpatialHashConfig config{};
    std::function<std::unique_ptr<btBroadphaseInterface>(const SpatialHashConfig&)> make =
        [](const SpatialHashConfig& with) { return std::make_unique<SpatialHashBroadphase>(with); };
    int group = Proxy::CharacterFilter;
    bool isCallbackLate = false;  // set after the character has been added

    /// How many bodies the box that the character set last touches with its ghost knowing, and how
    /// many without, summed over the steps.
    std::size_t known = 0;
    std::size_t unknown = 0;

    void run() {
        GhostWorld scene(make(config));
        scene.world.getPairCache()->setInternalGhostPairCallback(
            isCallbackLate ? nullptr : &scene.ghostCallback);
        btPairCachingGhostObject body;
        btCapsuleShape capsule(btScalar(0.4), 1);
        body.setCollisionShape(&capsule);
        body.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
        body.setWorldTransform(GhostWorld::at({94, 0, btScalar(0.9)}));
        btKinematicCharacterController character(&body, &capsule, btScalar(0.3));
        character.setGravity({0, 0, 0});
        character.setWalkDirection({btScalar(0.23), 0, btScalar(-0.013)});
        scene.world.addCollisionObject(&body, group, Proxy::AllFilter);
        scene.world.addAction(&character);
        scene.world.getPairCache()->setInternalGhostPairCallback(&scene.ghostCallback);
        for (int step = 0; step < 200; ++step) {
            scene.world.stepSimulation(btScalar(1) / 60, 0);
            for (const int neighbour : scene.touching(body)) {
                btRigidBody& other = *scene.bodies[static_cast<std::size_t>(neighbour)];
                const bool isKnown =
                    body.getOverlappingPairCache()->findPair(
                        body.getBroadphaseHandle(), other.getBroadphaseHandle()) != nullptr;
                ++(isKnown ? known : unknown);
            }
        }
        scene.world.removeAction(&character);
        scene.world.removeCollisionObject(&body);
    }

    void expectAllKnown() {
        run();
        EXPECT_EQ(unknown, 0U);
        EXPECT_GT(known, 100U);
    }
};

TEST(KinematicCharacter, KnowsItsNeighboursWithinTheStepWhateverItsGroup) {
    for (const int group : {1, 2, 16, 32, 64, -1}) {
        SCOPED_TRACE(group);
        Walk{.group = group}.expectAllKnown();
    }
}

TEST(KinematicCharacter, KnowsItsNeighboursAsUnderBtDbvtBroadphase) {
    Walk walk{
        .make = [](const SpatialHashConfig&) { return std::make_unique<btDbvtBroadphase>(); }};
    walk.expectAllKnown();
}

TEST(KinematicCharacter, KnowsItsNeighboursWhenTheCallbackIsSetAfterItWasAdded) {
    Walk{.group = 1, .isCallbackLate = true}.expectAllKnown();
}

TEST(KinematicCharacter, KnowsItsNeighboursOverBulletsPairCaches) {
    btHashedOverlappingPairCache hashed;
    PairCache ours;
    for (btOverlappingPairCache* cache : {static_cast<btOverlappingPairCache*>(&hashed),
                                          static_cast<btOverlappingPairCache*>(&ours)}) {
        Walk walk{.make = [cache](const SpatialHashConfig& with) {
            return std::make_unique<SpatialHashBroadphase>(cache, with);
        }};
        walk.group = 1;
        walk.expectAllKnown();
        cache->setInternalGhostPairCallback(nullptr);
    }
}

/// Ours, or Bullet's.
std::unique_ptr<btBroadphaseInterface> makeBroadphase(bool isOurs) {
    if (isOurs) {
        return std::make_unique<SpatialHashBroadphase>();
    }
    return std::make_unique<btDbvtBroadphase>();
}

// As a trigger does of what is spawned into it.
TEST(EagerGhosts, HearAtOnceOfWhatIsCreatedWhereTheyStand) {
    for (const bool isOurs : {false, true}) {
        SCOPED_TRACE(isOurs);
        GhostWorld scene(makeBroadphase(isOurs));
        scene.world.performDiscreteCollisionDetection();
        btRigidBody spawned(1, nullptr, &scene.small);
        spawned.setWorldTransform(GhostWorld::at({btScalar(0.5), 0, 0}));
        scene.world.addRigidBody(&spawned);
        EXPECT_TRUE(GhostWorld::doesList(scene.ghost, spawned));
        EXPECT_TRUE(GhostWorld::doesList(scene.cachingGhost, spawned));
        scene.world.removeRigidBody(&spawned);
        EXPECT_FALSE(GhostWorld::doesList(scene.ghost, spawned));
    }
}

// As of what a program puts into a trigger.
TEST(EagerGhosts, HearAtOnceOfWhatIsPutWhereTheyStand) {
    for (const bool isOurs : {false, true}) {
        SCOPED_TRACE(isOurs);
        GhostWorld scene(makeBroadphase(isOurs));
        btRigidBody carried(1, nullptr, &scene.small);
        carried.setCenterOfMassTransform(GhostWorld::at({50, 0, 0}));
        scene.world.addRigidBody(&carried);
        scene.world.performDiscreteCollisionDetection();
        EXPECT_FALSE(GhostWorld::doesList(scene.ghost, carried));
        carried.setCenterOfMassTransform(GhostWorld::at({btScalar(0.5), 0, 0}));
        scene.world.updateSingleAabb(&carried);
        EXPECT_TRUE(GhostWorld::doesList(scene.ghost, carried));
        EXPECT_TRUE(GhostWorld::doesList(scene.cachingGhost, carried));
        scene.world.removeRigidBody(&carried);
        EXPECT_FALSE(GhostWorld::doesList(scene.ghost, carried));
    }
}

/// A program's own callback, which tells ghosts by the one of Bullet.
struct ForwardingCallback : btOverlappingPairCallback {
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        return bullets.addOverlappingPair(a, b);
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* dispatcher) override {
        return bullets.removeOverlappingPair(a, b, dispatcher);
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
    btGhostPairCallback bullets;
};

/// A ghost in group 1 beside a body of a world, moved by hand.
struct GhostByHand {
    explicit GhostByHand(const SpatialHashConfig& config = {}) : broadphase(config) {
        for (btCollisionObject* object : {static_cast<btCollisionObject*>(&ghost), &body,
                                          static_cast<btCollisionObject*>(&far)}) {
            object->setCollisionShape(&box);
            object->setWorldTransform(GhostWorld::at({object == &far ? btScalar(50) : 0, 0, 0}));
        }
    }
    ~GhostByHand() {
        for (btCollisionObject* object : {static_cast<btCollisionObject*>(&ghost), &body,
                                          static_cast<btCollisionObject*>(&far)}) {
            if (object->getBroadphaseHandle() != nullptr) {
                world.removeCollisionObject(object);
            }
        }
    }
    void moveTo(btScalar x) {
        ghost.setWorldTransform(GhostWorld::at({x, 0, 0}));
        world.updateSingleAabb(&ghost);
    }
    void watchBy(btOverlappingPairCallback* watcher) {
        world.getPairCache()->setInternalGhostPairCallback(watcher);
    }
    int pairCount() { return world.getPairCache()->getNumOverlappingPairs(); }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    SpatialHashBroadphase broadphase;
    btCollisionWorld world{&dispatcher, &broadphase, &configuration};
    btBoxShape box{btVector3(1, 1, 1)};
    btGhostObject ghost;
    btCollisionObject body;
    btCollisionObject far;
    btGhostPairCallback bullets;
};

TEST(EagerGhosts, ListWhatIsThereWhenTheyComeAndMove) {
    ForwardingCallback forwarding;
    GhostByHand scene;
    for (btOverlappingPairCallback* callback :
         {static_cast<btOverlappingPairCallback*>(&scene.bullets),
          static_cast<btOverlappingPairCallback*>(&forwarding)}) {
        scene.watchBy(callback);
        scene.world.addCollisionObject(&scene.body);
        scene.world.addCollisionObject(&scene.far);
        scene.world.addCollisionObject(&scene.ghost);
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
        scene.moveTo(50);
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 2) << "until the step ends";
        scene.world.performDiscreteCollisionDetection();
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
        EXPECT_EQ(scene.ghost.getOverlappingObject(0), &scene.far);
        scene.moveTo(0);
        for (btCollisionObject* object :
             {static_cast<btCollisionObject*>(&scene.ghost), &scene.body, &scene.far}) {
            scene.world.removeCollisionObject(object);
        }
    }
}

TEST(EagerGhosts, MakePairsInTheStepWhereNobodyIsTold) {
    GhostByHand scene;
    scene.world.addCollisionObject(&scene.body);
    scene.world.addCollisionObject(&scene.ghost);
    EXPECT_EQ(scene.pairCount(), 0);
    scene.watchBy(&scene.bullets);
    scene.moveTo(btScalar(0.1));
    EXPECT_EQ(scene.pairCount(), 1) << "The callback was set after the ghost was added.";
    scene.watchBy(nullptr);
    scene.world.addCollisionObject(&scene.far);
    scene.moveTo(50);
    EXPECT_EQ(scene.pairCount(), 1) << "The callback was taken away.";
    scene.world.performDiscreteCollisionDetection();
    EXPECT_EQ(scene.pairCount(), 1);
}

TEST(EagerGhosts, HearInTheStepOfWhatMovesIntoThemOrWhileNobodyWasTold) {
    GhostByHand scene;
    scene.watchBy(&scene.bullets);
    scene.world.addCollisionObject(&scene.ghost);
    scene.world.addCollisionObject(&scene.far);
    const auto put = [&](btScalar x) {
        scene.far.setWorldTransform(GhostWorld::at({x, 0, 0}));
        scene.world.updateSingleAabb(&scene.far);
    };
    put(3);
    put(btScalar(1.5));  // as far as it may be from where it was, and touch that
    EXPECT_EQ(scene.pairCount(), 0);
    scene.world.performDiscreteCollisionDetection();
    EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
    put(50);
    scene.world.performDiscreteCollisionDetection();
    scene.watchBy(nullptr);
    put(1);
    scene.world.addCollisionObject(&scene.body);
    EXPECT_EQ(scene.pairCount(), 0);
}

// A ghost around all of them hears of each jump; what they are to each other waits for the step, so that
// its order follows from where they are.
TEST(EagerGhosts, LeaveTheOrderOfOtherPairsToTheStep) {
    std::vector<std::vector<int>> orders;
    for (const bool doJump : {false, true}) {
        GhostByHand scene;
        scene.watchBy(&scene.bullets);
        btBoxShape around(btVector3(200, 200, 200));
        scene.ghost.setCollisionShape(&around);
        scene.world.addCollisionObject(&scene.ghost);
        std::array<btCollisionObject, 4> bodies;
        const auto put = [&](std::size_t i, btScalar x) {
            bodies.at(i).setWorldTransform(GhostWorld::at({x, 0, 0}));
            scene.world.updateSingleAabb(&bodies.at(i));
        };
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            bodies.at(i).setCollisionShape(&scene.box);
            bodies.at(i).setWorldTransform(GhostWorld::at({btScalar(i) * 20, 0, 0}));
            scene.world.addCollisionObject(&bodies.at(i));
        }
        scene.world.performDiscreteCollisionDetection();
        for (btScalar x = 60; x > btScalar(20.5); x -= doJump ? btScalar(39.5) : btScalar(0.5)) {
            put(3, x - (doJump ? btScalar(39.5) : btScalar(0.5)));
        }
        for (btScalar x = 40; x > btScalar(0.5); x -= doJump ? btScalar(39.5) : btScalar(0.5)) {
            put(2, x - (doJump ? btScalar(39.5) : btScalar(0.5)));
        }
        EXPECT_EQ(scene.pairCount(), 4);
        scene.world.performDiscreteCollisionDetection();
        EXPECT_EQ(scene.pairCount(), 6);
        std::vector<int>& order = orders.emplace_back();
        btBroadphasePairArray& pairs = scene.world.getPairCache()->getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            order.push_back(pairs[i].m_pProxy0->m_uniqueId);
            order.push_back(pairs[i].m_pProxy1->m_uniqueId);
        }
        for (btCollisionObject& body : bodies) {
            scene.world.removeCollisionObject(&body);
        }
        scene.world.removeCollisionObject(&scene.ghost);
    }
    EXPECT_EQ(orders[0], orders[1]);
}

TEST(EagerGhosts, MakePairsInTheStepWhenTheyAreNotToBeEager) {
    SpatialHashConfig config;
    config.eagerGhosts = false;
    GhostByHand scene(config);
    scene.watchBy(&scene.bullets);
    scene.world.addCollisionObject(&scene.body);
    scene.world.addCollisionObject(&scene.ghost);
    EXPECT_EQ(scene.pairCount(), 0);
}

TEST(EagerGhosts, LeaveClientsAloneThatBulletDoesNotTakeForObjects) {
    void* const nobody = reinterpret_cast<void*>(std::uintptr_t{64});  // whoever reads it crashes
    PairJournal journal;
    const auto createAndMove = [&](SpatialHashBroadphase& broadphase, void* client, int mask,
                                   btDispatcher* dispatcher) {
        btBroadphaseProxy* proxy =
            broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, client, 1, mask, dispatcher);
        broadphase.setAabb(proxy, {5, 0, 0}, {6, 1, 1}, dispatcher);
        EXPECT_EQ(proxy->m_clientObject, client);
        broadphase.destroyProxy(proxy, dispatcher);
    };
    GhostByHand scene;
    createAndMove(scene.broadphase, nobody, -1, &scene.dispatcher);
    scene.watchBy(&journal);
    createAndMove(scene.broadphase, nobody, -1, nullptr);
    createAndMove(scene.broadphase, nobody, 0, &scene.dispatcher);
    createAndMove(scene.broadphase, nullptr, -1, &scene.dispatcher);
    SpatialHashConfig config;
    config.eagerGhosts = false;
    GhostByHand others(config);
    others.watchBy(&journal);
    createAndMove(others.broadphase, nobody, -1, &others.dispatcher);
    scene.watchBy(nullptr);
    others.watchBy(nullptr);
}

// A group is the program's: none of them makes a world search for pairs twice.
TEST(Groups, CostTheSameWhateverTheirBits) {
    for (const int group : {1, 2, 16, 32, 64, -1}) {
        SCOPED_TRACE(group);
        SpatialHashBroadphase broadphase;
        BulletRandom random(7);
        std::vector<btBroadphaseProxy*> proxies;
        for (int i = 0; i < 500; ++i) {
            const btVector3 at = random.vector(-5, 5);
            proxies.push_back(broadphase.createProxy(at, at + btVector3(1, 1, 1), 0, nullptr, group,
                                                     Proxy::AllFilter, nullptr));
        }
        EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
        for (int frame = 0; frame < 5; ++frame) {
            const std::uint64_t filings = broadphase.grid().filingCount();
            for (btBroadphaseProxy* proxy : proxies) {
                const btVector3 by = random.vector(btScalar(-0.1), btScalar(0.1));
                broadphase.setAabb(proxy, proxy->m_aabbMin + by, proxy->m_aabbMax + by, nullptr);
            }
            EXPECT_EQ(broadphase.grid().filingCount(), filings);
            broadphase.calculateOverlappingPairs(nullptr);
            EXPECT_EQ(broadphase.grid().filingCount(), filings + 1);
        }
    }
}

// The tests above can fail.
TEST(KinematicCharacter, DoesNotKnowThemInTimeWhereGhostsAreNotEager) {
    Walk walk;
    walk.config.eagerGhosts = false;
    walk.run();
    EXPECT_GT(walk.unknown, 0U);
}

}  // namespace
}  // namespace hashphase::test
