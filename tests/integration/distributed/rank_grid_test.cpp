// SPDX-License-Identifier: Zlib
#include <tests/integration/distributed/rank_scenes.hpp>
#include <tests/integration/distributed/rank_world.hpp>

#include <algorithm>
#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
struct RankScript {
    std::uint32_t ranks = 4;
    int frames = 60;
    double partitionShare = 0.15;  // of frames in which the partition changes
};

// A partition that nobody would choose: cuts through the corners of boxes, and anywhere.
template <class Scalar>
Partition<Scalar> randomPartition(Random& random, const RankWorld<Scalar>& world) {
    std::vector<Cut<Scalar>> cuts;
    while (cuts.size() + 1 < world.rankCount()) {
        auto at = static_cast<Scalar>(random.between(-20, 20));
        const auto axis = random.below(3);
        if (!world.objects.empty() && random.chance(0.7)) {
            auto object = world.objects.begin();
            std::advance(object, random.below(static_cast<std::uint32_t>(world.objects.size())));
            const Aabb<Scalar>& box = world.box(object->first);
            const Scalar corner = random.chance(0.5) ? box.min()[axis] : box.max()[axis];
            at = std::isnan(corner) ? at : corner;
        }
        cuts.push_back({at, axis});
    }
    return Partition<Scalar>(cuts);
}

template <class Scalar>
void play(Random& random, const BoxScene<Scalar>& scene, const RankScript<Scalar>& script) {
    RankGridConfig config;
    config.payloadBytes = random.chance(0.5) ? 4 : 0;
    config.grid.updatesBeforeRest = 2;
    RankWorld<Scalar> world(Partition<Scalar>(std::vector<Cut<Scalar>>(script.ranks - 1)), config);
    std::vector<GlobalId> ids;
    const auto addOne = [&] {
        const ProxyGroups groups =
            random.chance(0.1) ? ProxyGroups{.group = 2, .mask = 1} : ProxyGroups{};
        ids.push_back(world.add(random.below(script.ranks), scene.draw(random), groups));
    };
    for (std::uint32_t i = 0; i < scene.count; ++i) {
        addOne();
    }
    for (int frame = 0; frame < script.frames; ++frame) {
        if (random.chance(script.partitionShare)) {
            world.setPartition(random.chance(0.5) ? randomPartition(random, world)
                                                  : world.balanced());
        }
        const double moving = random.chance(0.2) ? 1 : random.between(0, 0.3);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            if (random.chance(moving)) {
                world.move(ids[i], random.chance(0.9) ? scene.nudge(random, world.box(ids[i]))
                                                      : scene.draw(random));
            }
            if (config.payloadBytes > 0 && random.chance(0.1)) {
                world.write(ids[i], random.below(1'000'000));
            }
            if (random.chance(0.03)) {
                const GlobalId object = ids[i];
                world.remove(object);
                const std::uint32_t rank = random.below(script.ranks);
                if (random.chance(0.5) && world.ranks[rank]->find(object).isNull()) {
                    world.add(object, rank, scene.draw(random));  // another one of the same name
                } else {
                    ids[i] = ids.back();
                    ids.pop_back();
                }
            }
        }
        while (ids.size() < scene.count) {
            addOne();
        }
        world.update();
        if (testing::Test::HasFailure()) {
            FAIL() << "in frame " << frame;
        }
        if (frame % 5 == 0 || frame + 1 == script.frames) {
            world.check();
        }
    }
}

template <class Scalar>
void playScenes(std::uint32_t seed) {
    const auto scenes = allBoxScenes<Scalar>();
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        SCOPED_TRACE(scenes[i].name);
        Random random(seed + static_cast<std::uint32_t>(i));
        RankScript<Scalar> script;
        script.ranks = 1 + random.below(9);
        play(random, scenes[i], script);
        if (testing::Test::HasFailure()) {
            return;
        }
    }
}

// Some 8,000 frames each.
TEST(RankGrid, ReportsTogetherWhatOneGridReports) {
    for (std::uint32_t seed = 0; seed < 800 && !HasFailure(); seed += 100) {
        playScenes<float>(seed);
    }
}

TEST(RankGrid, ReportsTogetherWhatOneGridReportsInDoublePrecision) {
    for (std::uint32_t seed = 0; seed < 800 && !HasFailure(); seed += 100) {
        playScenes<double>(10'000 + seed);
    }
}

// What ranks find hard to share, with balanced partitions that follow.
TEST(RankGrid, ReportsTheSameOfPopulationsThatTravelAndCrowd) {
    using Boxes = MovingBoxes<float>;
    for (const auto kind : Boxes::kKinds) {
        SCOPED_TRACE(Boxes::nameOf(kind));
        for (const std::uint32_t ranks : {2U, 5U, 16U}) {
            Boxes boxes(kind, 1000, 3);
            RankWorld<float> world(Partition<float>(std::vector<Cut<float>>(ranks - 1)));
            std::vector<GlobalId> ids;
            for (const Aabb<float>& box : boxes.boxes) {
                ids.push_back(world.add(0, box));
            }
            for (int frame = 0; frame < 40 && !HasFailure(); ++frame) {
                world.update();
                world.check();
                if (frame % 4 == 0) {
                    world.setPartition(world.balanced());
                }
                boxes.advance();
                for (std::size_t i = 0; i < ids.size(); ++i) {
                    world.move(ids[i], boxes.boxes[i]);
                }
            }
        }
    }
}

TEST(RankGrid, SaysWhereItsObjectsHaveGone) {
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}), {{}, 4});
    const GlobalId object = world.add(0, makeBox<float>(-3, 0, 0, -2, 1, 1));
    world.update();
    world.write(object, 77);
    world.move(object, makeBox<float>(2, 0, 0, 3, 1, 1));
    world.update();
    EXPECT_EQ(1U, world.objects.at(object).rank);
    EXPECT_EQ(0U, world.ranks[0]->grid().size());
    world.check();
}

// What has died is named though other objects have taken the places of those that are gone.
TEST(RankGrid, NamesDeadPairsToTheEndOfTheFrame) {
    RankGrid<float> grid(0, {});
    const ProxyId first = grid.add(GlobalId{10}, makeBox<float>(0, 0, 0, 1, 1, 1));
    grid.add(GlobalId{11}, makeBox<float>(0, 0, 0, 1, 1, 1));
    grid.pack();
    grid.finish({});
    grid.remove(first);
    grid.pack();
    const RankChanges changes = grid.finish({});
    ASSERT_EQ(1U, changes.pairs.died.size());
    const ProxyId next = grid.add(GlobalId{99}, makeBox<float>(5, 0, 0, 6, 1, 1));
    EXPECT_EQ(first.index, next.index);
    EXPECT_EQ((GlobalPair{GlobalId{10}, GlobalId{11}}), grid.globalPair(changes.pairs.died[0]));
    EXPECT_EQ(GlobalId{99}, grid.globalId(next));
}

TEST(RankGrid, IsNotUpToDateWithAnotherPartition) {
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}));
    world.add(0, makeBox<float>(-1, 0, 0, 1, 1, 1));
    EXPECT_FALSE(world.ranks[0]->isUpToDate());
    world.update();
    EXPECT_TRUE(world.ranks[0]->isUpToDate());
    world.setPartition(Partition<float>(std::vector<Cut<float>>{{5, 0}}));
    EXPECT_FALSE(world.ranks[0]->isUpToDate());
    world.update();
    EXPECT_TRUE(world.ranks[1]->isUpToDate());
}

// Told is what has changed, at the border alone.
TEST(RankGrid, TellsNothingOfWhatStandsStillOrLiesWithin) {
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}));
    std::vector<GlobalId> ids;
    for (int i = -50; i < 50; ++i) {
        ids.push_back(world.add(0, makeBox<float>(i - 0.1, 0, 0, i + 0.7, 1, 1)));
    }
    world.update();
    world.update();
    EXPECT_EQ(0U, world.ranks[0]->lastCost().bytesSent);
    for (const GlobalId id : ids) {
        const Aabb<float> box = world.box(id);
        world.move(id, Aabb<float>(box.min(), box.max().array() + 0.01F));
    }
    world.update();
    EXPECT_EQ(1U, world.ranks[0]->lastCost().entriesSent);  // of the one across the cut
    EXPECT_EQ(1U, world.ranks[0]->lastCost().parcelsSent);
    EXPECT_EQ(0U, world.ranks[1]->lastCost().bytesSent);
    world.check();
}

}  // namespace
}  // namespace hashphase::test
