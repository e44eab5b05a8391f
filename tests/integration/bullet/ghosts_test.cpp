// SPDX-License-Identifier: Zlib
//
// What ghost objects, sensors and characters see: every pair told once when it begins and once when
// it ends, in time, and never a body that has long left.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/integration/bullet/pair_journal.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
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

/// Without changes of filters, after which a pair may rightly be removed and made again at once.
Script scriptWithoutFilters(const Scene& scene) {
    Script script = makeScript(scene, kObjects, 60, kSeed);
    for (Frame& frame : script.frames) {
        std::erase_if(frame, [](const Command& command) {
            return command.action == Action::regroup || command.action == Action::changeFilter;
        });
    }
    return script;
}

std::vector<PairJournal::Uids> intersection(const std::set<PairJournal::Uids>& a,
                                            const std::set<PairJournal::Uids>& b) {
    std::vector<PairJournal::Uids> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
}

class GhostCallbacks : public testing::TestWithParam<Scene> {
protected:
    /// Plays a life over the cache and checks the journal after every frame.
    static void expectBalance(std::unique_ptr<btOverlappingPairCache> cache, const Script& script,
                              const SpatialHashConfig& config = {}) {
        PairJournal journal;
        cache->setInternalGhostPairCallback(&journal);
        {
            Player player = hashPlayer(kObjects, std::move(cache), config);
            for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
                SCOPED_TRACE("frame " + std::to_string(frame));
                player.play(script.frames[frame]);
                player.calculate();
                ASSERT_EQ(journal.errors(), std::vector<std::string>{});
                ASSERT_EQ(journal.alive(), uidPairs(player.cache()));
            }
            EXPECT_FALSE(journal.alive().empty());
        }
        EXPECT_EQ(journal.errors(), std::vector<std::string>{});
        EXPECT_TRUE(journal.alive().empty()) << "Destroying all proxies ends all pairs.";
    }
};

TEST_P(GhostCallbacks, BalanceInOurPairCache) {
    expectBalance(std::make_unique<PairCache>(), makeScript(GetParam(), kObjects, 60, kSeed));
}

TEST_P(GhostCallbacks, BalanceInBulletsPairCache) {
    expectBalance(std::make_unique<btHashedOverlappingPairCache>(),
                  makeScript(GetParam(), kObjects, 60, kSeed));
}

TEST_P(GhostCallbacks, BalanceWhenEverybodyIsEager) {
    SpatialHashConfig config;
    config.eagerGroups = Proxy::AllFilter;
    expectBalance(std::make_unique<PairCache>(), makeScript(GetParam(), kObjects, 60, kSeed),
                  config);
}

// A pair that is removed and made again loses its contacts, however briefly it was gone.
TEST_P(GhostCallbacks, SayNothingOfAPairThatIsThereAtBothEndsOfAStep) {
    const Script script = scriptWithoutFilters(GetParam());
    PairJournal journal;
    Player player = hashPlayer(kObjects);
    player.cache().setInternalGhostPairCallback(&journal);
    std::size_t keptCount = 0;
    for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
        const std::set<PairJournal::Uids> before = journal.alive();
        player.play(script.frames[frame]);
        player.calculate();
        const std::vector<PairJournal::Uids> kept = intersection(before, journal.alive());
        const std::set<PairJournal::Uids> keptSet(kept.begin(), kept.end());
        ASSERT_EQ(intersection(keptSet, journal.takeTouched()), std::vector<PairJournal::Uids>{})
            << "frame " << frame;
        keptCount += kept.size();
    }
    EXPECT_GT(keptCount, 1000U);
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
    void create(int object, const Box& box, int group) {
        player.play({Action::create, object, box, group, Proxy::AllFilter});
    }
    void set(int object, const Box& box) { player.play({Action::set, object, box, 0, 0}); }

    Player player = hashPlayer(8, nullptr, eagerCharactersAndSensors());
    const ObjectPairs none{};
};

TEST_P(EagerGroups, HaveTheirPairsDirectlyAfterCreateProxy) {
    create(0, kOrigin, Proxy::DefaultFilter);
    create(1, kNearby, Proxy::DefaultFilter);
    EXPECT_EQ(player.pairs(), none) << "Others have theirs after calculateOverlappingPairs.";
    create(2, kOrigin, GetParam());
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 2}, {1, 2}}));
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}, {0, 2}, {1, 2}}));
}

TEST_P(EagerGroups, HaveTheirPairsDirectlyAfterSetAabb) {
    create(0, kOrigin, Proxy::DefaultFilter);
    create(1, kAway, Proxy::DefaultFilter);
    create(2, kAway, Proxy::DefaultFilter);
    create(3, kOrigin, GetParam());
    player.calculate();
    ASSERT_EQ(player.pairs(), (ObjectPairs{{0, 3}, {1, 2}}));
    set(3, kAway);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 3}, {1, 2}, {1, 3}, {2, 3}}))
        << "New pairs at once; old ones stay until calculateOverlappingPairs.";
    set(2, kOrigin);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 3}, {1, 2}, {1, 3}, {2, 3}}))
        << "What is not eager neither gains nor loses pairs before calculateOverlappingPairs.";
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 2}, {1, 3}}));
}

TEST_P(EagerGroups, KeepThePairsOfAPlaceTheyPassedUntilTheStepEnds) {
    create(0, kOrigin, Proxy::DefaultFilter);
    create(1, kAway, GetParam());
    player.calculate();
    set(1, kOrigin);
    set(1, kAway);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    player.calculate();
    EXPECT_EQ(player.pairs(), none);
    set(1, kOrigin);
    set(1, kNearby);
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
}

TEST_P(EagerGroups, MayBeDestroyedBeforeTheStepEnds) {
    create(0, kOrigin, Proxy::DefaultFilter);
    create(1, kOrigin, GetParam());
    player.play({Action::destroy, 1, {}, 0, 0});
    EXPECT_EQ(player.pairs(), none);
    create(1, kOrigin, GetParam());
    player.play({Action::destroy, 0, {}, 0, 0});
    EXPECT_EQ(player.pairs(), none);
    player.calculate();
    EXPECT_EQ(player.pairs(), none);
}

INSTANTIATE_TEST_SUITE_P(Groups, EagerGroups,
                         testing::Values(Proxy::CharacterFilter, Proxy::SensorTrigger,
                                         Proxy::CharacterFilter | Proxy::DebrisFilter));

// --- Bullet's own ghosts -------------------------------------------------------------------------

TEST(GhostObject, NeverListsWhatHasLeft) {
    GhostWorld scene;
    std::size_t listedCount = 0;
    for (int step = 0; step < 1000; ++step) {
        // In for a few steps, then away for a few hundred.
        btRigidBody& guest = *scene.bodies[static_cast<std::size_t>(step / 250 * 7)];
        guest.setWorldTransform(GhostWorld::at({0, step % 250 < 5 ? btScalar(0) : 50, 0}));
        scene.world.stepSimulation(btScalar(1) / 60, 0);
        ASSERT_EQ(scene.listedBy(scene.ghost), scene.touching(scene.ghost)) << "step " << step;
        ASSERT_EQ(scene.listedBy(scene.cachingGhost), scene.touching(scene.cachingGhost));
        ASSERT_EQ(scene.cachingGhost.getOverlappingPairCache()->getNumOverlappingPairs(),
                  scene.cachingGhost.getNumOverlappingObjects());
        listedCount += scene.listedBy(scene.ghost).size();
    }
    EXPECT_EQ(listedCount, 20U);
}

TEST(GhostObject, ForgetsABodyThatIsRemoved) {
    GhostWorld scene;
    btRigidBody& guest = *scene.bodies.front();
    guest.setWorldTransform(GhostWorld::at({0, 0, 0}));
    scene.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_EQ(scene.listedBy(scene.ghost), std::vector<int>{0});
    scene.world.removeRigidBody(&guest);
    EXPECT_TRUE(scene.listedBy(scene.ghost).empty());
    EXPECT_TRUE(scene.listedBy(scene.cachingGhost).empty());
    scene.world.addRigidBody(&guest);
    scene.world.stepSimulation(btScalar(1) / 60, 0);
    EXPECT_EQ(scene.listedBy(scene.ghost), std::vector<int>{0});
}

}  // namespace
}  // namespace hashphase::test
