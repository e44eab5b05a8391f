// SPDX-License-Identifier: Zlib
//
// Ghosts and characters have their pairs at once, by what they are; groups mean nothing.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/ghost_world.hpp>

#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

/// A character that walks between pillars.
struct Walk {
    std::unique_ptr<btBroadphaseInterface> broadphase;
    int group = Proxy::CharacterFilter;
    bool isCallbackLate = false;  // set after the character has been added

    /// How many bodies the box that the character set last touches with its ghost knowing, and how
    /// many without, summed over the steps.
    std::size_t known = 0;
    std::size_t unknown = 0;

    Walk& run() {
        GhostWorld scene(std::move(broadphase));
        scene.cache().setInternalGhostPairCallback(nullptr);
        if (!isCallbackLate) {
            scene.tellGhosts();
        }
        btPairCachingGhostObject body;
        btCapsuleShape capsule(btScalar(0.4), 1);
        body.setCollisionShape(&capsule);
        body.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
        body.setWorldTransform(placeAt({94, 0, btScalar(0.9)}));
        btKinematicCharacterController character(&body, &capsule, btScalar(0.3));
        character.setGravity({0, 0, 0});
        character.setWalkDirection({btScalar(0.23), 0, btScalar(-0.013)});
        scene.world().addCollisionObject(&body, group, Proxy::AllFilter);
        scene.world().addAction(&character);
        scene.tellGhosts();
        for (int step = 0; step < 200; ++step) {
            scene.step();
            for (const int neighbour : scene.touching(body)) {
                const bool isKnown = body.getOverlappingPairCache()->findPair(
                                         body.getBroadphaseHandle(),
                                         scene.body(neighbour).getBroadphaseHandle()) != nullptr;
                ++(isKnown ? known : unknown);
            }
        }
        scene.world().removeAction(&character);
        scene.world().removeCollisionObject(&body);
        return *this;
    }

    static void expectAllKnown(Walk walk) {
        walk.run();
        EXPECT_EQ(walk.unknown, 0U);
        EXPECT_GT(walk.known, 100U);
    }
};

SpatialHashConfig notEager() {
    SpatialHashConfig config;
    config.eagerGhosts = false;
    return config;
}

TEST(KinematicCharacter, KnowsItsNeighboursWithinTheStepWhateverItsGroupAndTheCache) {
    for (const int group : {1, 2, 16, 32, 64, -1}) {
        SCOPED_TRACE(group);
        Walk::expectAllKnown({makeBroadphase<SpatialHashBroadphase>(), group});
    }
    for (const CacheKind& kind : {kCacheKinds[1], kCacheKinds[3]}) {
        const std::unique_ptr<btOverlappingPairCache> cache = kind.make();
        Walk::expectAllKnown({hashOver(cache.get()), 1});
        Walk::expectAllKnown({std::make_unique<SpatialHashBroadphase>(cache.get()), 1});
        cache->setInternalGhostPairCallback(nullptr);
    }
    // The callback is set after it was added.
    Walk::expectAllKnown({makeBroadphase<SpatialHashBroadphase>(), 1, true});
}

// The test above can fail.
TEST(KinematicCharacter, DoesNotKnowThemInTimeWhereGhostsAreNotEager) {
    EXPECT_GT(Walk{std::make_unique<SpatialHashBroadphase>(notEager())}.run().unknown, 0U);
}

// As a trigger does of what is spawned into it, or what a program puts there.
TEST(EagerGhosts, HearAtOnceOfWhatIsCreatedOrPutWhereTheyStand) {
    for (const auto make :
         {makeBroadphase<SpatialHashBroadphase>, makeBroadphase<btDbvtBroadphase>}) {
        for (const bool isPut : {false, true}) {
            SCOPED_TRACE(isPut);
            GhostWorld scene(make());
            btRigidBody body(1, nullptr, &scene.small);
            body.setCenterOfMassTransform(placeAt({isPut ? btScalar(50) : btScalar(0.5), 0, 0}));
            scene.detect();
            scene.world().addRigidBody(&body);
            if (isPut) {
                scene.detect();
                EXPECT_FALSE(GhostWorld::doesList(scene.ghost, body));
                body.setCenterOfMassTransform(placeAt({btScalar(0.5), 0, 0}));
                scene.world().updateSingleAabb(&body);
            }
            EXPECT_TRUE(GhostWorld::doesList(scene.ghost, body));
            EXPECT_TRUE(GhostWorld::doesList(scene.cachingGhost, body));
            scene.world().removeRigidBody(&body);
            EXPECT_FALSE(GhostWorld::doesList(scene.ghost, body));
        }
    }
}

/// A ghost in group 1 beside objects of a world.
struct GhostByHand : ObjectWorld {
    using ObjectWorld::ObjectWorld;
    ~GhostByHand() {
        watchBy(nullptr);
        removeAll();
    }

    void add(btCollisionObject& object, btScalar x = 0) {
        ObjectWorld::add(object,
                         object.getCollisionShape() != nullptr ? *object.getCollisionShape() : box,
                         {x, 0, 0});
    }
    void put(btCollisionObject& object, btScalar x) { move(object, {x, 0, 0}); }

    btGhostObject ghost;
    btCollisionObject body;
    btCollisionObject far;
};

TEST(EagerGhosts, ListWhatIsThereWhenTheyComeAndMoveWhicheverCallbackTellsThem) {
    for (const bool isForwarded : {false, true}) {
        GhostByHand scene;
        PairJournal forwarding;  // a program's own, which tells ghosts by the one of Bullet
        forwarding.onBirth = [&](Proxy* a, Proxy* b) {
            scene.ghostCallback.addOverlappingPair(a, b);
        };
        forwarding.onDeath = [&](Proxy* a, Proxy* b) {
            scene.ghostCallback.removeOverlappingPair(a, b, &scene.dispatcher);
        };
        if (isForwarded) {
            scene.watchBy(&forwarding);
        }
        scene.add(scene.body);
        scene.add(scene.far, 50);
        scene.add(scene.ghost);
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
        scene.put(scene.ghost, 50);
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 2) << "until the step ends";
        scene.detect();
        EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
        EXPECT_EQ(scene.ghost.getOverlappingObject(0), &scene.far);
    }
}

TEST(EagerGhosts, MakePairsInTheStepWhereNobodyIsTold) {
    GhostByHand scene;
    scene.watchBy(nullptr);
    scene.add(scene.body);
    scene.add(scene.ghost);
    EXPECT_EQ(scene.pairCount(), 0);
    scene.watchBy(&scene.ghostCallback);
    scene.put(scene.ghost, btScalar(0.1));
    EXPECT_EQ(scene.pairCount(), 1) << "The callback was set after the ghost was added.";
    scene.watchBy(nullptr);
    scene.add(scene.far, 50);
    scene.put(scene.ghost, 50);
    EXPECT_EQ(scene.pairCount(), 1) << "The callback was taken away.";
    scene.detect();
    EXPECT_EQ(scene.pairCount(), 1);
}

TEST(EagerGhosts, HearInTheStepOfWhatMovesIntoThemOrWhileNobodyWasTold) {
    GhostByHand scene;
    scene.add(scene.ghost);
    scene.add(scene.far, 50);
    scene.put(scene.far, 3);
    scene.put(scene.far, btScalar(1.5));  // as far as it may be from where it was, and touch that
    EXPECT_EQ(scene.pairCount(), 0);
    scene.detect();
    EXPECT_EQ(scene.ghost.getNumOverlappingObjects(), 1);
    scene.put(scene.far, 50);
    scene.detect();
    scene.watchBy(nullptr);
    scene.put(scene.far, 1);
    scene.add(scene.body);
    EXPECT_EQ(scene.pairCount(), 0);
}

// A ghost around all of them hears of each jump; what they are to each other waits for the step, so that
// its order follows from where they are.
TEST(EagerGhosts, LeaveTheOrderOfOtherPairsToTheStep) {
    std::vector<std::vector<Uids>> orders;
    for (const btScalar stride : {btScalar(0.5), btScalar(39.5)}) {
        btBoxShape around(btVector3(200, 200, 200));
        std::array<btCollisionObject, 4> bodies;
        GhostByHand scene;
        scene.ghost.setCollisionShape(&around);
        scene.add(scene.ghost);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            scene.add(bodies.at(i), btScalar(i) * 20);
        }
        scene.detect();
        for (btScalar x = 60; x > btScalar(20.5); x -= stride) {
            scene.put(bodies[3], x - stride);
        }
        for (btScalar x = 40; x > btScalar(0.5); x -= stride) {
            scene.put(bodies[2], x - stride);
        }
        EXPECT_EQ(scene.pairCount(), 4);
        scene.detect();
        EXPECT_EQ(scene.pairCount(), 6);
        orders.push_back(uidList(scene.cache));
    }
    EXPECT_EQ(orders[0], orders[1]);
}

TEST(EagerGhosts, MakePairsInTheStepWhenTheyAreNotToBeEager) {
    GhostByHand scene(notEager());
    scene.add(scene.body);
    scene.add(scene.ghost);
    EXPECT_EQ(scene.pairCount(), 0);
}

TEST(EagerGhosts, LeaveClientsAloneThatBulletDoesNotTakeForObjects) {
    void* const nobody = reinterpret_cast<void*>(std::uintptr_t{64});  // whoever reads it crashes
    PairJournal told;
    const auto createAndMove = [&](GhostByHand& scene, void* client, int mask, bool isOfAWorld) {
        btDispatcher* const dispatcher = isOfAWorld ? &scene.dispatcher : nullptr;
        Proxy* const proxy =
            scene.broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, client, 1, mask, dispatcher);
        scene.broadphase.setAabb(proxy, {5, 0, 0}, {6, 1, 1}, dispatcher);
        EXPECT_EQ(proxy->m_clientObject, client);
        scene.broadphase.destroyProxy(proxy, dispatcher);
    };
    GhostByHand scene;
    scene.watchBy(nullptr);
    createAndMove(scene, nobody, -1, true);
    scene.watchBy(&told);
    createAndMove(scene, nobody, -1, false);
    createAndMove(scene, nobody, 0, true);
    createAndMove(scene, nullptr, -1, true);
    GhostByHand others(notEager());
    others.watchBy(&told);
    createAndMove(others, nobody, -1, true);
}

// A ghost that was added before there was a callback is known as one when its box is set.
TEST(EagerGhosts, MayDestroyOthersOfABatchThoughTheyWereNotKnownBefore) {
    btGhostObject ghost;
    std::array<btCollisionObject, 2> objects;
    PairJournal journal;
    ObjectWorld scene;
    scene.watchBy(nullptr);
    scene.add(ghost, scene.box, {50, 0, 0});
    scene.add(objects[0], scene.box, {0, 0, 0});
    scene.add(objects[1], scene.box, {20, 0, 0});
    scene.watchBy(&journal);
    journal.onBirth = [&](auto*, auto*) { scene.world.removeCollisionObject(&objects[1]); };
    const std::array batch{ghost.getBroadphaseHandle(), objects[1].getBroadphaseHandle()};
    const std::array<btVector3, 2> lows{btVector3(-1, -1, -1), btVector3(90, 0, 0)};
    const std::array<btVector3, 2> highs{btVector3(1, 1, 1), btVector3(91, 1, 1)};
    scene.broadphase.setAabbs(batch, lows, highs, &scene.dispatcher);
    EXPECT_EQ(objects[1].getBroadphaseHandle(), nullptr);
    EXPECT_EQ(scene.broadphase.grid().size(), 2U);
    EXPECT_EQ(scene.pairCount(), 1);
    scene.broadphase.calculateOverlappingPairs(&scene.dispatcher);
    EXPECT_EQ(scene.broadphase.validate(), "");
    scene.watchBy(nullptr);
}

// A group is the program's: none of them makes a world search for pairs twice.
TEST(Groups, CostTheSameWhateverTheirBits) {
    for (const int group : {1, 2, 16, 32, 64, -1}) {
        SCOPED_TRACE(group);
        Boxes boxes;
        BulletRandom random(7);
        for (int i = 0; i < 500; ++i) {
            boxes.create(boxAround(random.vector(-5, 5), {1, 1, 1}), group);
        }
        EXPECT_EQ(boxes.pairCount(), 0);
        for (int frame = 0; frame < 5; ++frame) {
            const std::uint64_t filings = boxes.broadphase.grid().filingCount();
            for (Proxy* proxy : boxes.proxies) {
                const btVector3 by = random.vector(-0.1, 0.1);
                boxes.set(proxy, {proxy->m_aabbMin + by, proxy->m_aabbMax + by});
            }
            EXPECT_EQ(boxes.broadphase.grid().filingCount(), filings);
            boxes.step();
            EXPECT_EQ(boxes.broadphase.grid().filingCount(), filings + 1);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
