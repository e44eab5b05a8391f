// SPDX-License-Identifier: Zlib
//
// "Identical pair sets": after every calculateOverlappingPairs, over lives of objects in nine
// scenes, our pairs are those of brute force and those of Bullet's broadphases, both ways.

#include <tests/integration/bullet/broadphases.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kObjects = 300;
constexpr int kFrames = 72;
constexpr std::uint64_t kSeed = 20260;

std::vector<SpatialHashConfig> configurations() {
    std::vector<SpatialHashConfig> all(5);
    all[0].grid.cellSize = 0.1;
    all[0].grid.levelRatio = 2;
    all[1].grid.cellSize = 30;
    all[1].grid.levelRatio = 16;
    all[2].grid.updatesBeforeRest = 1'000'000;
    all[3].grid.updatesBeforeRest = 1;
    all[3].eagerGroups = btBroadphaseProxy::AllFilter;
    all[4].eagerGroups = 0;
    return all;
}

struct Contender {
    std::string name;
    Player player;
};

/// All that must have precisely the pairs that overlap.
std::vector<Contender> contenders(int objectCount) {
    std::vector<Contender> all;
    all.push_back(
        {"btSimpleBroadphase", Player(objectCount, makeBroadphase<btSimpleBroadphase>())});
    all.push_back({"exact btDbvtBroadphase", Player(objectCount, makeBroadphase<ExactDbvt>())});
    for (const CacheKind& kind : cacheKinds()) {
        all.push_back({kind.name, hashPlayer(objectCount, kind.make())});
    }
    for (const SpatialHashConfig& config : configurations()) {
        all.push_back({"configuration " + std::to_string(all.size()),
                       hashPlayer(objectCount, nullptr, config)});
    }
    return all;
}

class PairSets : public testing::TestWithParam<Scene> {};

TEST_P(PairSets, AreThoseOfBruteForceUnderEveryBroadphaseCacheAndConfiguration) {
    const Script script = makeScript(GetParam(), kObjects, kFrames, kSeed);
    Truth truth(kObjects);
    std::vector<Contender> all = contenders(kObjects);
    Player none = hashPlayer(kObjects, std::make_unique<btNullPairCache>());
    Player loose(kObjects, makeBroadphase<btDbvtBroadphase>());
    std::size_t pairCount = 0;
    std::size_t extraCount = 0;
    for (std::size_t frame = 0; frame < script.frames.size() && !HasFailure(); ++frame) {
        SCOPED_TRACE("frame " + std::to_string(frame));
        truth.play(script.frames[frame]);
        const ObjectPairs expected = truth.pairs();
        pairCount += expected.size();
        for (Contender& each : all) {
            each.player.play(script.frames[frame]);
            EXPECT_EQ(difference(each.player.pairsAfterStep(), expected), "") << each.name;
            if (auto* hash = dynamic_cast<SpatialHashBroadphase*>(&each.player.broadphase())) {
                EXPECT_EQ(hash->validate(), "") << each.name;
            }
        }
        none.play(script.frames[frame]);
        EXPECT_EQ(none.pairsAfterStep(), ObjectPairs{});
        loose.play(script.frames[frame]);
        loose.calculate();
        EXPECT_EQ(difference(expected, loose.overlappingPairs()), "");
        EXPECT_EQ(excess(expected, loose.pairs()), "");
        extraCount += loose.pairs().size() - expected.size();
    }
    EXPECT_GT(pairCount, std::size_t(kFrames * kObjects / 4)) << "The scene is too thin.";
    EXPECT_GT(extraCount, 0U) << "Nothing tells the two sets of btDbvtBroadphase apart.";
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
    Player dbvt(kMany, makeBroadphase<ExactDbvt>());
    for (const Frame& frame : script.frames) {
        hash.play(frame);
        dbvt.play(frame);
        ASSERT_EQ(difference(hash.pairsAfterStep(), dbvt.pairsAfterStep()), "");
    }
}

}  // namespace
}  // namespace hashphase::test
