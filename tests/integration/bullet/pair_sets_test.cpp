// SPDX-License-Identifier: Zlib
//
// "Identical pair sets": after every calculateOverlappingPairs, over lives of boxes in all scenes, our
// pairs are those of brute force and those of Bullet's broadphases, both ways.

#include <tests/integration/bullet/scripted_boxes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::uint64_t kSeed = 20260;

std::vector<SpatialHashConfig> configurations() {
    std::vector<SpatialHashConfig> all(5);
    all[0].grid.cellSize = 0.1;
    all[0].grid.levelRatio = 2;
    all[1].grid.cellSize = 30;
    all[1].grid.levelRatio = 16;
    all[2].grid.updatesBeforeRest = 1'000'000;
    all[3].grid.updatesBeforeRest = 1;
    all[3].grid.slack = btScalar(0.3);
    all[3].eagerGroups = btBroadphaseProxy::AllFilter;
    all[4].eagerGroups = 0;
    return all;
}

/// All that must have precisely the pairs that overlap; the first one is ours as it comes. Bullet's tree
/// bears no NaN.
void addContenders(std::deque<AnyBoxes>& all, bool withTree) {
    for (const CacheKind& kind : kCacheKinds) {
        all.emplace_back(kind.make(), eagerCharactersAndSensors());
    }
    for (const SpatialHashConfig& config : configurations()) {
        all.emplace_back(makeCache<PairCache>(), config);
    }
    all.emplace_back(makeBroadphase<btSimpleBroadphase>());
    if (withTree) {
        all.emplace_back(makeBroadphase<ExactDbvt>());
    }
}

class PairSets : public testing::TestWithParam<std::size_t> {
protected:
    static constexpr int kFrames = 60;

    /// A pair that is removed and made again loses its contacts, however briefly it was gone.
    void expectNothingSaidOfPairsThatLast(const std::set<Uids>& before) {
        const std::set<Uids> touched = journal.takeTouched();
        for (const Uids& pair : before) {
            const auto isPainted = [this](int uid) {
                return world.painted.contains({static_cast<std::uint32_t>(uid - 1), 1});
            };
            if (journal.alive.contains(pair) && !isPainted(pair.first) && !isPainted(pair.second)) {
                EXPECT_FALSE(touched.contains(pair));
                ++keptCount;
            }
        }
        world.painted.clear();
    }

    const BoxScene<btScalar> scene = allBoxScenes<btScalar>()[GetParam()];
    PairJournal journal;
    ScriptedBoxes world;
    std::size_t keptCount = 0;
};

TEST_P(PairSets, AreThoseOfBruteForceUnderEveryBroadphaseCacheAndConfiguration) {
    const CaughtMessages aboutNan;
    const bool isHostile = scene.name == hostileScene<btScalar>().name;
    addContenders(world.all, !isHostile);
    AnyBoxes& ours = world.all.front();
    journal.hasLivingClient = hasLivingClient;
    ours.pairCache().setInternalGhostPairCallback(&journal);
    Script<btScalar> script(scene, kSeed,
                            {.goBad = isHostile ? 0.05 : 0, .recolour = 0.03, .replace = 0.03});
    script.begin(world);
    AnyBoxes none(makeCache<btNullPairCache>());
    std::size_t pairCount = 0;
    for (int frame = 0; frame < kFrames && !HasFailure(); ++frame) {
        SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
        const std::set<Uids> before = journal.alive;
        if (frame == kFrames / 4 || frame == kFrames * 3 / 4) {
            world.decideByFilter(frame < kFrames / 2);
        }
        script.playFrame(world);
        for (std::size_t i = 0; i < script.proxies().size(); i += 20) {
            world.move(script.proxies()[i].id, scene.draw(script.random()));
            world.move(script.proxies()[i].id, script.proxies()[i].box);  // and back
        }
        const auto expected = pairsByBruteForce<btScalar>(script.proxies());
        pairCount += expected.size();
        for (std::size_t i = 0; i < world.all.size(); ++i) {
            world.all[i].step();
            EXPECT_EQ(differences(ScriptedBoxes::pairs(world.all[i]), expected), "") << i;
            if (auto* hash = dynamic_cast<SpatialHashBroadphase*>(world.all[i].over.get())) {
                EXPECT_EQ(hash->validate(), "") << i;
            }
        }
        expectNothingSaidOfPairsThatLast(before);
    }
    EXPECT_GT(pairCount, 1000U) << "The scene is too thin.";
    EXPECT_GT(keptCount, 300U);
    ours.destroyAll();
    EXPECT_TRUE(journal.alive.empty()) << "Destroying all proxies ends all pairs.";
    EXPECT_EQ(journal.errors, std::vector<std::string>{});
    for (std::size_t i = 0; i < 2; ++i) {
        none.create({{0, 0, 0}, {1, 1, 1}});
    }
    none.step();
    EXPECT_EQ(none.pairCount(), 0);
}

std::string nameOf(const testing::TestParamInfo<std::size_t>& info) {
    std::string name = allBoxScenes<btScalar>()[info.param].name;
    std::erase_if(
        name, [](char letter) { return std::isalnum(static_cast<unsigned char>(letter)) == 0; });
    return name + std::to_string(info.param);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PairSets,
                         testing::Range<std::size_t>(0, allBoxScenes<btScalar>().size()), nameOf);

// Tables of many thousands behave as those of a few hundred.
TEST(PairSetsOfMany, EqualBtDbvtBroadphaseThatIsForcedToBeExact) {
    BoxScene<btScalar> scene = spreadScene<btScalar>("large", 1, 0);
    scene.count = 12'000;
    scene.draw = boxesIn<btScalar>(-25, 25, 0.2, 0.8);
    ScriptedBoxes world;
    world.all.emplace_back(makeCache<PairCache>());
    world.all.emplace_back(makeBroadphase<ExactDbvt>());
    Script<btScalar> script(scene, kSeed, {.goBad = 0});
    script.begin(world);
    for (int frame = 0; frame < 20; ++frame) {
        script.playFrame(world);
        for (AnyBoxes& boxes : world.all) {
            boxes.step();
        }
        ASSERT_EQ(
            differences(ScriptedBoxes::pairs(world.all[0]), ScriptedBoxes::pairs(world.all[1])),
            "");
    }
    EXPECT_GT(ScriptedBoxes::pairs(world.all[0]).size(), 4000U);
}

}  // namespace
}  // namespace hashphase::test
