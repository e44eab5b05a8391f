// SPDX-License-Identifier: Zlib
//
// What ghost objects, sensors and characters see: every pair told once when it begins and once when
// it ends, in time, and never a body that has long left.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/ghost_world.hpp>

#include <gtest/gtest.h>

#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

constexpr int kObjects = 200;
constexpr std::uint64_t kSeed = 99;

std::set<Uids> intersection(const std::set<Uids>& a, const std::set<Uids>& b) {
    std::set<Uids> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(),
                          std::inserter(both, both.begin()));
    return both;
}

class GhostCallbacks : public testing::TestWithParam<Scene> {};

// A pair that is removed and made again loses its contacts, however briefly it was gone. After a change
// of filters it may be.
TEST_P(GhostCallbacks, SayNothingOfAPairThatIsThereAtBothEndsOfAStep) {
    Script script = makeScript(GetParam(), kObjects, 60, kSeed);
    PairJournal journal;
    auto player = std::make_unique<Player>(hashPlayer(kObjects));
    player->cache().setInternalGhostPairCallback(&journal);
    std::size_t keptCount = 0;
    for (Frame& frame : script.frames) {
        std::erase_if(frame, [](const Command& command) {
            return command.action == Action::regroup || command.action == Action::changeFilter;
        });
        const std::set<Uids> before = journal.alive();
        player->play(frame);
        player->calculate();
        const std::set<Uids> kept = intersection(before, journal.alive());
        ASSERT_EQ(intersection(kept, journal.takeTouched()), std::set<Uids>{});
        keptCount += kept.size();
    }
    EXPECT_GT(keptCount, 1000U);
    player.reset();
    EXPECT_TRUE(journal.alive().empty()) << "Destroying all proxies ends all pairs.";
    EXPECT_EQ(journal.errors(), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Scenes, GhostCallbacks, testing::ValuesIn(allScenes()),
                         [](const auto& scene) { return scene.param.name; });

// --- Eager groups --------------------------------------------------------------------------------

const Box kOrigin = boxAround({0, 0, 0}, {1, 1, 1});
const Box kNearby = boxAround({1, 0, 0}, {1, 1, 1});
const Box kAway = boxAround({9, 0, 0}, {1, 1, 1});

class EagerGroups : public testing::TestWithParam<int> {
protected:
    Player player = hashPlayer(8, nullptr, eagerCharactersAndSensors());
    const ObjectPairs none{};
};

TEST_P(EagerGroups, HaveTheirPairsDirectlyAfterCreateProxy) {
    player.create(0, kOrigin);
    player.create(1, kNearby);
    EXPECT_EQ(player.pairs(), none) << "Others have theirs after calculateOverlappingPairs.";
    player.create(2, kOrigin, GetParam());
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 2}, {1, 2}}));
    EXPECT_EQ(player.pairsAfterStep(), (ObjectPairs{{0, 1}, {0, 2}, {1, 2}}));
}

TEST_P(EagerGroups, HaveTheirPairsDirectlyAfterSetAabb) {
    player.create(0, kOrigin);
    player.create(1, kAway);
    player.create(2, kAway);
    player.create(3, kOrigin, GetParam());
    ASSERT_EQ(player.pairsAfterStep(), (ObjectPairs{{0, 3}, {1, 2}}));
    player.set(3, kAway);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 3}, {1, 2}, {1, 3}, {2, 3}}))
        << "New pairs at once; old ones stay until calculateOverlappingPairs.";
    player.set(2, kOrigin);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 3}, {1, 2}, {1, 3}, {2, 3}}))
        << "What is not eager neither gains nor loses pairs before calculateOverlappingPairs.";
    EXPECT_EQ(player.pairsAfterStep(), (ObjectPairs{{0, 2}, {1, 3}}));
}

TEST_P(EagerGroups, KeepThePairsOfAPlaceTheyPassedUntilTheStepEnds) {
    player.create(0, kOrigin);
    player.create(1, kAway, GetParam());
    player.calculate();
    player.set(1, kOrigin);
    player.set(1, kAway);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    EXPECT_EQ(player.pairsAfterStep(), none);
    player.set(1, kOrigin);
    player.set(1, kNearby);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    EXPECT_EQ(player.pairsAfterStep(), (ObjectPairs{{0, 1}}));
}

INSTANTIATE_TEST_SUITE_P(Groups, EagerGroups,
                         testing::Values(Proxy::CharacterFilter, Proxy::SensorTrigger,
                                         Proxy::CharacterFilter | Proxy::DebrisFilter));

// --- What Bullet's own ghosts list ---------------------------------------------------------------

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

}  // namespace
}  // namespace hashphase::test
