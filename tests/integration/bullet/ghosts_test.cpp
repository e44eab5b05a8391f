// SPDX-License-Identifier: Zlib
//
// What Bullet's own ghosts list: what is there, in time, and never a body that has long left.

#include <tests/integration/bullet/ghost_world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

// In for a few steps, then away for a few hundred.
TEST(GhostObject, NeverListsWhatHasLeft) {
    GhostWorld scene;
    std::size_t listedCount = 0;
    for (int step = 0; step < 1000; ++step) {
        scene.body(step / 250 * 7)
            .setWorldTransform(placeAt({0, step % 250 < 5 ? btScalar(0) : 50, 0}));
        scene.step();
        for (btGhostObject* const ghost : scene.ghosts()) {
            ASSERT_EQ(scene.listedBy(*ghost), scene.touching(*ghost)) << "step " << step;
        }
        ASSERT_EQ(scene.cachingGhost.getOverlappingPairCache()->getNumOverlappingPairs(),
                  scene.cachingGhost.getNumOverlappingObjects());
        listedCount += scene.listedBy(scene.ghost).size();
    }
    EXPECT_EQ(listedCount, 20U);
}

TEST(GhostObject, ForgetsABodyThatIsRemoved) {
    GhostWorld scene;
    scene.body(0).setWorldTransform(placeAt({0, 0, 0}));
    scene.step();
    ASSERT_EQ(scene.listedBy(scene.ghost), std::vector<int>{0});
    scene.takeOut(0);
    EXPECT_TRUE(scene.listedBy(scene.ghost).empty());
    EXPECT_TRUE(scene.listedBy(scene.cachingGhost).empty());
    scene.world().addRigidBody(&scene.body(0));
    scene.step();
    EXPECT_EQ(scene.listedBy(scene.ghost), std::vector<int>{0});
}

/// Ghosts stay nearby, as do some of the bodies; the others are a hundred metres away.
btVector3 nearby(BulletRandom& random) {
    return random.vector(-4, 4);
}

/// Bodies teleport, fly, push one another, leave the world and come back, sleep and wake; ghosts move.
void live(GhostWorld& scene, BulletRandom& random) {
    for (int i = 0; i < scene.bodyCount(); ++i) {
        btRigidBody& body = scene.body(i);
        const btScalar fate = random.uniform(0, 1);
        if (fate < btScalar(0.06)) {
            body.forceActivationState(DISABLE_DEACTIVATION);
            putAt(body, random.chance(0.4) ? nearby(random) : random.vector(50, 150));
            body.setLinearVelocity(random.vector(-6, 6));
            body.setInterpolationLinearVelocity(body.getLinearVelocity());
            if (!body.isInWorld()) {
                scene.world().addRigidBody(&body);
            }
        } else if (fate < btScalar(0.13) && body.isInWorld()) {
            if (fate < btScalar(0.08)) {
                scene.takeOut(i);
            } else {
                body.forceActivationState(fate < btScalar(0.11) ? ISLAND_SLEEPING
                                                                : DISABLE_DEACTIVATION);
            }
        }
    }
    for (btGhostObject* const ghost : scene.ghosts()) {
        if (random.chance(0.2)) {
            putAt(*ghost, nearby(random));
        }
    }
}

/// What ghosts list, summed over the steps of a life.
struct Listed {
    std::size_t right = 0;
    std::size_t stale = 0;    // listed, but gone
    std::size_t missing = 0;  // there, but not listed

    void compare(btGhostObject& ghost, btCollisionObject& other) {
        const bool isListed = GhostWorld::doesList(ghost, other);
        const bool isThere = GhostWorld::touches(ghost, other);
        right += isListed && isThere ? 1 : 0;
        stale += isListed && !isThere ? 1 : 0;
        missing += !isListed && isThere ? 1 : 0;
    }
};

Listed lifeOver(std::unique_ptr<btBroadphaseInterface> broadphase, bool updatesSleeping) {
    GhostWorld scene(std::move(broadphase));
    scene.world().setForceUpdateAllAabbs(updatesSleeping);
    BulletRandom random(0x6057);
    Listed listed;
    for (int step = 0; step < 400; ++step) {
        live(scene, random);
        scene.step();
        for (int i = 0; i < scene.bodyCount(); ++i) {
            listed.compare(scene.ghost, scene.body(i));
            listed.compare(scene.cachingGhost, scene.body(i));
        }
        listed.compare(scene.ghost, scene.cachingGhost);
        listed.compare(scene.cachingGhost, scene.ghost);
        EXPECT_EQ(scene.cachingGhost.getOverlappingPairCache()->getNumOverlappingPairs(),
                  scene.cachingGhost.getNumOverlappingObjects());
    }
    return listed;
}

TEST(GhostLists, HoldWhatIsThereAndNothingElseInEveryStep) {
    for (const bool updatesSleeping : {false, true}) {
        const Listed listed = lifeOver(makeBroadphase<SpatialHashBroadphase>(), updatesSleeping);
        EXPECT_GT(listed.right, 1000U);
        EXPECT_EQ(listed.stale, 0U);
        EXPECT_EQ(listed.missing, 0U);
    }
}

// The test above can fail.
TEST(GhostLists, KeepWhatHasLeftUnderBtDbvtBroadphase) {
    EXPECT_GT(lifeOver(makeBroadphase<btDbvtBroadphase>(), true).stale, 100U);
}

// A contact-ended callback may remove a body of the pair that ends: a ghost in that pair is told of its end.
TEST(GhostObject, HearOfTheEndOfAPairWhoseContactsEndAndRemoveItsBody) {
    static btCollisionObject* victim;
    static ObjectWorld* where;
    using End = std::function<void(ObjectWorld&, btCollisionObject&)>;
    const std::array<End, 3> ends{
        [](ObjectWorld& scene, btCollisionObject& body) {
            scene.move(body, {50, 0, 0});
            scene.detect();
        },
        [](ObjectWorld& scene, btCollisionObject& body) {
            btCollisionObject* const ghost = scene.world.getCollisionObjectArray()[0];
            scene.broadphase.ignorePair(ghost->getBroadphaseHandle(), body.getBroadphaseHandle(),
                                        &scene.dispatcher);
            scene.detect();
        },
        [](ObjectWorld& scene, btCollisionObject& body) {
            body.getBroadphaseHandle()->m_collisionFilterMask = 0;
            scene.broadphase.refilter(body.getBroadphaseHandle(), &scene.dispatcher);
            scene.detect();
        }};
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const End& end : ends) {
            btGhostObject ghost;
            btCollisionObject body;
            ObjectWorld scene({}, order);
            scene.add(ghost, scene.box, {0, 0, 0});
            scene.add(body, scene.box, {btScalar(1.5), 0, 0});
            scene.detect();
            ASSERT_EQ(ghost.getNumOverlappingObjects(), 1);
            where = &scene;
            victim = &body;
            gContactEndedCallback = [](btPersistentManifold* const& /*manifold*/) {
                if (victim != nullptr) {
                    where->world.removeCollisionObject(std::exchange(victim, nullptr));
                }
            };
            end(scene, body);
            gContactEndedCallback = nullptr;
            EXPECT_EQ(victim, nullptr);
            EXPECT_EQ(ghost.getNumOverlappingObjects(), 0);
            EXPECT_EQ(scene.pairCount(), 0);
            scene.detect();
            EXPECT_EQ(scene.broadphase.validate(), "");
        }
    }
}

}  // namespace
}  // namespace hashphase::test
