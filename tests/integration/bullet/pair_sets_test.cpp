// SPDX-License-Identifier: Zlib
//
// "Identical pair sets": after every calculateOverlappingPairs, over lives of objects in nine
// scenes, our pairs are those of brute force and those of Bullet's broadphases, both ways.

#include <tests/integration/bullet/broadphases.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kObjects = 300;
constexpr int kFrames = 72;
constexpr std::uint64_t kSeed = 20260;

/// Plays the scene's script on all players together and calls check(truth) after every frame.
void playTogether(const Scene& scene, const std::vector<Player*>& players,
                  const std::function<void(const Truth&)>& check) {
    const Script script = makeScript(scene, kObjects, kFrames, kSeed);
    Truth truth(kObjects);
    for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
        SCOPED_TRACE("frame " + std::to_string(frame));
        truth.play(script.frames[frame]);
        for (Player* const player : players) {
            player->play(script.frames[frame]);
            player->calculate();
        }
        check(truth);
        if (testing::Test::HasFailure()) {
            return;  // whatever follows is a consequence
        }
    }
}

class PairSets : public testing::TestWithParam<Scene> {};

// The references agree, or nothing below would mean anything.
TEST_P(PairSets, OfBruteForceAndBtSimpleBroadphaseAgree) {
    Player simple(kObjects, std::make_unique<btSimpleBroadphase>());
    std::size_t pairCount = 0;
    playTogether(GetParam(), {&simple}, [&](const Truth& truth) {
        const ObjectPairs expected = truth.pairs();
        EXPECT_EQ(difference(simple.pairs(), expected), "");
        pairCount += expected.size();
    });
    EXPECT_GT(pairCount, std::size_t(kFrames * kObjects / 4)) << "The scene is too thin.";
}

TEST_P(PairSets, EqualBruteForceInEveryFrame) {
    Player hash = hashPlayer(kObjects);
    playTogether(GetParam(), {&hash}, [&](const Truth& truth) {
        EXPECT_EQ(difference(hash.pairs(), truth.pairs()), "");
        EXPECT_EQ(hashOf(hash).validate(), "");
    });
}

TEST_P(PairSets, EqualBtSimpleBroadphaseInEveryFrame) {
    Player hash = hashPlayer(kObjects);
    Player simple(kObjects, std::make_unique<btSimpleBroadphase>());
    playTogether(GetParam(), {&hash, &simple},
                 [&](const Truth&) { EXPECT_EQ(difference(hash.pairs(), simple.pairs()), ""); });
}

TEST_P(PairSets, AreThoseOfBtDbvtBroadphaseThatOverlap) {
    Player hash = hashPlayer(kObjects);
    Player dbvt(kObjects, std::make_unique<btDbvtBroadphase>());
    std::size_t extraCount = 0;
    playTogether(GetParam(), {&hash, &dbvt}, [&](const Truth&) {
        EXPECT_EQ(difference(hash.pairs(), dbvt.overlappingPairs()), "");
        EXPECT_EQ(excess(hash.pairs(), dbvt.pairs()), "");
        extraCount += dbvt.pairs().size() - hash.pairs().size();
    });
    EXPECT_GT(extraCount, 0U) << "Nothing tells the two sets of btDbvtBroadphase apart.";
}

TEST_P(PairSets, EqualBtDbvtBroadphaseThatIsForcedToBeExact) {
    Player hash = hashPlayer(kObjects);
    Player dbvt(kObjects, std::make_unique<ExactDbvt>());
    playTogether(GetParam(), {&hash, &dbvt},
                 [&](const Truth&) { EXPECT_EQ(difference(hash.pairs(), dbvt.pairs()), ""); });
}

TEST_P(PairSets, AreTheSameInEveryPairCache) {
    Player own = hashPlayer(kObjects, std::make_unique<PairCache>());
    Player hashed = hashPlayer(kObjects, std::make_unique<btHashedOverlappingPairCache>());
    Player deferred = hashPlayer(kObjects, std::make_unique<btSortedOverlappingPairCache>());
    Player none = hashPlayer(kObjects, std::make_unique<btNullPairCache>());
    playTogether(GetParam(), {&own, &hashed, &deferred, &none}, [&](const Truth& truth) {
        const ObjectPairs expected = truth.pairs();
        EXPECT_EQ(difference(own.pairs(), expected), "");
        EXPECT_EQ(difference(hashed.pairs(), expected), "");
        EXPECT_EQ(difference(deferred.pairs(), expected), "");
        EXPECT_EQ(difference(none.pairs(), {}), "");
    });
}

TEST_P(PairSets, AreTheSameInEveryConfiguration) {
    SpatialHashConfig fine;
    fine.grid.cellSize = 0.1;
    fine.grid.levelRatio = 2;
    SpatialHashConfig coarse;
    coarse.grid.cellSize = 30;
    coarse.grid.levelRatio = 16;
    SpatialHashConfig restless;
    restless.grid.updatesBeforeRest = 1'000'000;
    SpatialHashConfig eager;
    eager.grid.updatesBeforeRest = 1;
    eager.eagerGroups = btBroadphaseProxy::AllFilter;
    SpatialHashConfig lazy;
    lazy.eagerGroups = 0;

    std::vector<Player> players;
    for (const SpatialHashConfig& config : {fine, coarse, restless, eager, lazy}) {
        players.push_back(hashPlayer(kObjects, nullptr, config));
    }
    std::vector<Player*> all;
    for (Player& player : players) {
        all.push_back(&player);
    }
    playTogether(GetParam(), all, [&](const Truth& truth) {
        const ObjectPairs expected = truth.pairs();
        for (std::size_t i = 0; i < players.size(); ++i) {
            SCOPED_TRACE("configuration " + std::to_string(i));
            EXPECT_EQ(difference(players[i].pairs(), expected), "");
            EXPECT_EQ(hashOf(players[i]).validate(), "");
        }
    });
}

TEST_P(PairSets, AreExactHoweverSeldomTheyAreAskedFor) {
    const Script script = makeScript(GetParam(), kObjects, kFrames, kSeed + 1);
    Truth truth(kObjects);
    Player hash = hashPlayer(kObjects);
    for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
        truth.play(script.frames[frame]);
        hash.play(script.frames[frame]);
        if (frame % 5 != 4) {
            continue;
        }
        hash.calculate();
        ASSERT_EQ(difference(hash.pairs(), truth.pairs()), "") << "frame " << frame;
        hash.calculate();
        ASSERT_EQ(difference(hash.pairs(), truth.pairs()), "") << "again, frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PairSets, testing::ValuesIn(allScenes()),
                         [](const auto& scene) { return scene.param.name; });

// Tables of many thousands behave as those of a few hundred.
TEST(PairSets, EqualBtDbvtBroadphaseThatIsForcedToBeExactInALargeWorld) {
    constexpr int kMany = 12'000;
    Scene scene = sceneNamed("uniform");
    scene.place = [](BulletRandom& random, int) {
        return boxAround(random.vector(-25, 25), random.vector(0.2, 0.8));
    };
    const Script script = makeScript(scene, kMany, 24, kSeed);
    Player hash = hashPlayer(kMany);
    Player dbvt(kMany, std::make_unique<ExactDbvt>());
    for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
        for (Player* const player : {&hash, &dbvt}) {
            player->play(script.frames[frame]);
            player->calculate();
        }
        ASSERT_EQ(difference(hash.pairs(), dbvt.pairs()), "") << "frame " << frame;
    }
}

}  // namespace
}  // namespace hashphase::test
