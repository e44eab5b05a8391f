// SPDX-License-Identifier: Zlib

// A grid that goes back is the grid that it was: whatever is done next has the same results, in the same order
// and at the same cost, as it had the first time.

#include <broadphase/grid_snapshot.hpp>

#include <tests/broadphase/played_grid.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
void expectTheSameAgain(const Play& play) {
    PlayedGrid<Scalar> world(play, 7);
    Log log;
    world.play(1, 30, log);
    typename PlayedGrid<Scalar>::Saved snapshot;
    for (std::uint64_t round = 0; round < 12; ++round) {
        SCOPED_TRACE(round);
        Log first;
        Log again;
        world.save(snapshot);
        world.play(100 + round, 1 + static_cast<int>(round % 12), first);
        world.play(200 + round, 1 + 3 * static_cast<int>(round % 4), log);
        if (round % 4 == 3) {
            world.forgetAll();
        }
        world.restore(snapshot);
        world.play(100 + round, 1 + static_cast<int>(round % 12), again);
        const auto [at, other] = std::ranges::mismatch(first, again);
        ASSERT_EQ(first, again) << "at " << at - first.begin();
    }
}

class GridSnapshotPlays : public testing::TestWithParam<Play> {};

TEST_P(GridSnapshotPlays, HaveTheSameResultsAgainInSinglePrecision) {
    expectTheSameAgain<float>(GetParam());
}
TEST_P(GridSnapshotPlays, HaveTheSameResultsAgainInDoublePrecision) {
    expectTheSameAgain<double>(GetParam());
}
INSTANTIATE_TEST_SUITE_P(All, GridSnapshotPlays, testing::ValuesIn(plays()),
                         [](const auto& play) { return play.param.name; });

TEST(GridSnapshot, GoesBackEightFramesInEachFrameAsIfItHadNeverGoneBack) {
    const Play play{"Netcode", 300, 0.3, 0.3, 12, 0.2, 0.05};
    PlayedGrid<float> straight(play, 5);
    PlayedGrid<float> rolled(play, 5);
    std::vector<PlayedGrid<float>::Saved> ring(8);
    Log log;
    constexpr std::uint64_t kFrames = 200;
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        Log expected;
        straight.play(frame, 1, expected);
        if (frame >= ring.size()) {  // go back, and make up for it
            rolled.restore(ring[frame % ring.size()]);
            for (std::uint64_t past = frame - ring.size(); past < frame; ++past) {
                rolled.save(ring[past % ring.size()]);
                rolled.play(past, 1, log);
            }
        }
        rolled.save(ring[frame % ring.size()]);
        Log actual;
        rolled.play(frame, 1, actual);
        ASSERT_EQ(actual, expected) << "frame " << frame;
    }
}

TEST(GridSnapshot, RestoreChangesNothingWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "no allocation fails here";
    }
    BetweenTwoStates whole;
    const Log now = whole.answers();
    whole.world.restore(whole.before);
    const Log then = whole.answers();
    const std::size_t failures = runOutOfMemory(
        [] {
            auto between = std::make_unique<BetweenTwoStates>();
            between->world.forgetAll();  // so that all of it is to be allocated
            between->world.grid.releaseUnusedMemory();
            return between;
        },
        [](BetweenTwoStates& between) { between.before.snapshot.restore(*between.world.pairs); },
        [&](BetweenTwoStates& between, std::size_t) {
            EXPECT_EQ(between.world.grid.validate(), "");
            between.world.restore(between.after);
            EXPECT_EQ(between.answers(), now);
            between.world.restore(between.before);
            EXPECT_EQ(between.answers(), then);
        });
    EXPECT_GT(failures, 5U);
}

TEST(GridSnapshot, SaveLeavesAnEmptySnapshotWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "no allocation fails here";
    }
    const std::size_t failures = runOutOfMemory([] { return std::make_unique<BetweenTwoStates>(); },
                                                [](BetweenTwoStates& between) {
                                                    between.before = {};
                                                    between.world.save(between.before);
                                                },
                                                [](BetweenTwoStates& between, std::size_t) {
                                                    if (between.before.snapshot.isEmpty()) {
                                                        between.world.save(between.before);
                                                    }
                                                    const Log first = between.answers();
                                                    between.world.restore(between.before);
                                                    EXPECT_EQ(between.answers(), first);
                                                });
    EXPECT_GT(failures, 5U);
}

TEST(GridSnapshot, AllocatesNothingInASteadyFrame) {
    PlayedGrid<float> world({"Steady", 300, 0.5, 0.01}, 3);
    PlayedGrid<float>::Saved saved;
    Log log;
    for (int frame = 0; frame < 40; ++frame) {
        world.update(log);
        world.save(saved);
        world.restore(saved);
    }
    const std::size_t before = allocationCount();
    for (int i = 0; i < 10; ++i) {
        saved.snapshot.save(*world.pairs);
        saved.snapshot.restore(*world.pairs);
    }
    EXPECT_EQ(allocationCount(), before);
}

TEST(GridSnapshot, PutsWhatWasSavedIntoAnotherGrid) {
    const Play play{"Any", 200, 0.5, 0.5, 12, 0.3, 0.1, 0.1};
    PlayedGrid<double> one(play, 3);
    PlayedGrid<double> other(play, 4);
    Log log;
    one.play(1, 20, log);
    other.play(2, 5, log);
    PlayedGrid<double>::Saved saved;
    one.save(saved);
    other.restore(saved);
    Log ofOne;
    Log ofOther;
    one.play(3, 10, ofOne);
    other.play(3, 10, ofOther);
    EXPECT_EQ(ofOne, ofOther);
    EXPECT_NE(one.grid.populationNumber(), other.grid.populationNumber());
}

TEST(GridSnapshot, KeptAnswersAreOutOfDateAfterIt) {
    Grid<float> grid;
    GridSnapshot<float> snapshot;
    snapshot.save(grid);
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1)));
    const std::uint64_t withOne = grid.populationNumber();
    snapshot.restore(grid);
    EXPECT_NE(grid.populationNumber(), withOne);
    static_cast<void>(grid.add(makeBox<float>(5, 0, 0, 6, 1, 1)));
    EXPECT_NE(grid.populationNumber(), withOne);
}

TEST(GridSnapshot, KeepsTheRoomThatWasReserved) {
    Grid<float> grid;
    GridSnapshot<float> snapshot;
    grid.reserve(1000);
    snapshot.save(grid);
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1)));
    snapshot.restore(grid);
    const std::size_t before = allocationCount();
    for (int i = 0; i < 1000; ++i) {
        static_cast<void>(grid.add(makeBox<float>(i, 0, 0, i + 1, 1, 1)));
    }
    EXPECT_EQ(allocationCount(), before);
}

// Those that came and went are in the list of changes, and memory was given back: there is more in the list than
// it needs for those that are left.
TEST(GridSnapshot, MakesRoomForChangesBehindThoseThatWereSaved) {
    const auto placed = [](int i) { return makeBox<float>(i, 0, 0, i + 1, 1, 1); };
    Grid<float> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        ids.push_back(grid.add(placed(i)));
    }
    grid.update();
    std::vector<ProxyId> come;
    for (int i = 0; i < 1000; ++i) {
        come.push_back(grid.add(placed(i)));
    }
    for (const ProxyId id : come) {
        grid.remove(id);
    }
    grid.releaseUnusedMemory();
    GridSnapshot<float> snapshot;
    snapshot.save(grid);
    Grid<float> other;
    snapshot.restore(other);
    for (int i = 0; i < 100; ++i) {
        other.move(ids[static_cast<std::size_t>(i)], placed(i + 1));
    }
    EXPECT_EQ(other.validate(), "");
    EXPECT_EQ(other.box(ids[99]).min().x(), 100);
}

#if HASHPHASE_ENABLE_ASSERTS

TEST(GridSnapshotMisuse, IsAssertedAndDoesNothing) {
    const ThrowingAsserts throwing;
    Grid<float> grid;
    Grid<float> otherwise({.cellSize = 2});
    const ProxyId id = grid.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    GridSnapshot<float> snapshot;
    EXPECT_THROW(snapshot.restore(grid), BrokenAssert);  // nothing was saved
    snapshot.save(grid);
    EXPECT_THROW(snapshot.restore(otherwise), BrokenAssert);
    {
        Pairs<float> pairs(grid);
        EXPECT_THROW(snapshot.save(grid), BrokenAssert);
        EXPECT_THROW(snapshot.restore(grid), BrokenAssert);
        EXPECT_THROW(snapshot.restore(pairs), BrokenAssert);  // none were saved
        snapshot.save(pairs);
    }
    EXPECT_THROW(snapshot.restore(grid), BrokenAssert);
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    EXPECT_THROW(snapshot.restore(pairs), BrokenAssert);  // followed no sweeps
    snapshot.save(pairs);
    pairs.update([&](ProxyId, ProxyId) {
        EXPECT_THROW(snapshot.save(pairs), BrokenAssert);
        EXPECT_THROW(snapshot.restore(pairs), BrokenAssert);
        return true;
    });
    EXPECT_TRUE(grid.contains(id));
}

#endif

}  // namespace
}  // namespace hashphase::test
