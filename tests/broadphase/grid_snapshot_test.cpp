// SPDX-License-Identifier: Zlib

// A grid that goes back is the grid that it was: whatever is done next has the same results, in the same order
// and at the same cost, as it had the first time.

#include <broadphase/grid_snapshot.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/forged_bytes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// All that calls have answered, as numbers.
using Log = std::vector<std::uint64_t>;

void note(Log& log, ProxyId id) {
    log.push_back(std::uint64_t{id.index} << 32 | id.generation);
}
void note(Log& log, const PairChanges& changes) {
    for (const auto& list : {changes.born, changes.died}) {
        log.push_back(list.size());
        for (const ProxyPair& pair : list) {
            note(log, pair.first);
            note(log, pair.second);
        }
    }
}
void note(Log& log, const QueryCost& cost) {
    log.push_back(cost.boxesTested);
    log.push_back(cost.hits);
}

/// What is played: how many proxies, how they move, and what else happens to them.
struct Play {
    std::string name;
    std::uint32_t count = 0;
    double moving = 1;    // share of the proxies that move in a frame
    double step = 0.5;    // [m]
    double extent = 12;   // [m]
    double refused = 0;   // share of pairs that the filter refuses
    double sweeping = 0;  // share of moves that are sweeps
    double grouping = 0;  // share of moves that set groups
    bool hasPairs = true;
    bool hasRays = false;
    GridConfig config{};
};

template <class Scalar>
class World {
public:
    World(const Play& play, std::uint64_t seed)
        : play_(play), random_(seed), grid(play.config), sweeps(grid) {
        if (play.hasPairs) {
            pairs = std::make_unique<Pairs<Scalar>>(grid, &sweeps);
        }
        for (std::uint32_t i = 0; i < play_.count; ++i) {
            add();
        }
    }

    /// Frames that depend on the state and on the seed alone.
    void play(std::uint64_t seed, int frames, Log& log) {
        random_ = Random(seed);
        for (int frame = 0; frame < frames; ++frame) {
            change(log);
            ask(log);
            if (random_.chance(0.9)) {
                update(log);
            }
            if (random_.chance(0.3)) {
                change(log);
            }
        }
    }

    void update(Log& log) {
        if (pairs == nullptr) {
            const UpdateCost cost = grid.update();
            if (notesCosts) {
                log.insert(log.end(), {cost.changed, cost.filed, cost.resting, cost.largestCell});
            }
            return;
        }
        note(log, pairs->update(filter()));
        const PairCost& cost = pairs->lastCost();
        log.push_back(pairs->count());
        if (notesCosts) {
            log.insert(log.end(), {cost.boxesTested, cost.pairsWatched, cost.grid.filed,
                                   cost.grid.resting, pairs->refusedCount()});
        }
        EXPECT_EQ(pairs->validate(), "");
        EXPECT_EQ(sweeps.validate(), "");
    }

    /// The grid, and what this program knows of it.
    struct Saved {
        GridSnapshot<Scalar> snapshot;
        std::vector<ProxyId> ids;
    };
    void save(Saved& saved) {
        saved.ids = ids_;
        pairs != nullptr ? saved.snapshot.save(*pairs) : saved.snapshot.save(grid);
    }
    void restore(const Saved& saved) {
        pairs != nullptr ? saved.snapshot.restore(*pairs) : saved.snapshot.restore(grid);
        ids_ = saved.ids;
    }
    void forgetAll() {
        pairs != nullptr ? pairs->clear() : grid.clear();
        ids_.clear();
    }

private:
    auto filter() {
        return [this](ProxyId a, ProxyId b) {
            const std::uint32_t key = (a.index * 2654435761U) ^ (b.index * 40503U);
            return (key >> 8) % 1000 >= play_.refused * 1000;
        };
    }
    void add() {
        const Vector3<double> middle = random_.pointIn(-play_.extent, play_.extent);
        const Vector3<double> half = random_.pointIn(0.2, random_.chance(0.02) ? 6 : 0.8);
        const auto mobility = random_.chance(0.1) ? Mobility::resting : Mobility::mobile;
        ids_.push_back(grid.add(boxAround<Scalar>(middle, half), mobility));
    }
    [[nodiscard]] ProxyId any() {
        return ids_[random_.below(static_cast<std::uint32_t>(ids_.size()))];
    }
    void change(Log& log) {
        const auto moves =
            static_cast<std::uint32_t>(play_.moving * static_cast<double>(ids_.size()));
        for (std::uint32_t i = 0; i < moves; ++i) {
            const ProxyId id = any();
            if (random_.chance(play_.sweeping)) {
                sweeps.set(id, random_.pointIn(-4, 4).template cast<Scalar>());
            } else if (random_.chance(play_.grouping)) {
                grid.setGroups(id, {1U << random_.below(4), ~(1U << random_.below(4))});
            } else if (random_.chance(0.005)) {
                grid.move(id, hostileBox<Scalar>(random_));
            } else {
                grid.move(id, shifted<Scalar>(random_, grid.box(id), play_.step));
            }
        }
        while (random_.chance(0.5) && ids_.size() > play_.count / 2) {
            const std::uint32_t victim = random_.below(static_cast<std::uint32_t>(ids_.size()));
            grid.remove(ids_[victim]);
            ids_[victim] = ids_.back();
            ids_.pop_back();
        }
        while (random_.chance(0.5)) {
            add();
            note(log, ids_.back());
        }
        if (pairs != nullptr && random_.chance(0.3)) {
            note(log, pairs->findPairsNow(any(), filter()));
        }
        if (pairs != nullptr && random_.chance(0.2)) {
            note(log, pairs->refilter(any(), filter()));
        }
        if (random_.chance(0.03)) {
            log.push_back(grid.shiftOrigin(random_.pointIn(-3, 3).template cast<Scalar>()));
        }
        log.insert(log.end(), {grid.size(), grid.indexLimit(), grid.nanCount()});
    }
    void ask(Log& log) {
        const auto collect = [&](const auto& region) {
            std::vector<ProxyId> found;
            CollectAll all(found);
            const QueryCost cost = grid.visit(region, all);
            if (notesCosts) {
                note(log, cost);
            } else {
                std::sort(found.begin(), found.end());
            }
            for (const ProxyId id : found) {  // in their order
                note(log, id);
            }
        };
        const auto draw = boxesIn<Scalar>(-play_.extent, play_.extent, 0.5, 4);
        for (std::uint32_t i = random_.below(8); i-- > 0;) {
            collect(BoxRegion<Scalar>{draw(random_)});
        }
        if (play_.hasRays && random_.chance(0.3)) {
            grid.expectRays(1000);
        }
        for (std::uint32_t i = play_.hasRays ? 4 : 0; i-- > 0;) {
            const Vector3<double> from = random_.pointIn(-20, 20);
            const Vector3<double> to = random_.pointIn(-20, 20);
            collect(RayRegion<Scalar>(from.template cast<Scalar>(), to.template cast<Scalar>()));
        }
        if (notesCosts) {
            log.push_back(grid.filingCount());
        }
    }

    Play play_;
    Random random_;
    std::vector<ProxyId> ids_;

public:
    bool notesCosts = true;  // and the order in which queries find proxies
    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps;
    std::unique_ptr<Pairs<Scalar>> pairs;
};

std::vector<Play> plays() {
    return {
        {"Few", 12},
        {"AllMove", 300},
        {"SomeMove", 600, 0.05},
        {"Tremble", 400, 1, 0.004},
        {"TrembleAndTravel", 400, 0.5, 0.004, 12, 0.1, 0.02},
        {"FilterRefuses", 300, 0.5, 0.5, 12, 0.4},
        {"FilterRefusesNearlyAllOfACrowd", 500, 0.2, 0.1, 1, 0.99},
        {"Sweeps", 300, 0.5, 0.5, 12, 0.2, 0.2},
        {"Groups", 300, 0.5, 0.5, 12, 0.2, 0.05, 0.2},
        {"WithoutPairs", 500, 0.1, 0.5, 12, 0, 0, 0, false, true},
        {"Rays", 800, 0.02, 0.5, 12, 0, 0, 0, true, true},
        {"FixedCells", 300, 0.5, 0.5, 12, 0.2, 0.1, 0, true, false, {.cellSize = 2}},
        {"FixedSlack", 300, 0.5, 0.02, 12, 0.2, 0, 0, true, true, {.slack = 0.05}},
    };
}

template <class Scalar>
void expectTheSameAgain(const Play& play) {
    World<Scalar> world(play, 7);
    Log log;
    world.play(1, 30, log);
    typename World<Scalar>::Saved snapshot;
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

/// As bytes and back.
template <class Scalar>
[[nodiscard]] GridSnapshot<Scalar> sent(const GridSnapshot<Scalar>& snapshot) {
    std::vector<std::byte> bytes;
    snapshot.write(bytes);
    GridSnapshot<Scalar> received;
    EXPECT_EQ(received.read(bytes), "");
    std::vector<std::byte> again;
    received.write(again);
    EXPECT_EQ(bytes, again);
    return received;
}

// Costs, and the order in which queries find proxies, are not sent.
template <class Scalar>
void expectTheSameWhereItIsSent(const Play& play) {
    World<Scalar> world(play, 7);
    World<Scalar> elsewhere(play, 8);
    Log log;
    world.notesCosts = elsewhere.notesCosts = false;
    world.play(1, 30, log);
    for (std::uint64_t round = 0; round < 24; ++round) {
        SCOPED_TRACE(round);
        typename World<Scalar>::Saved saved;
        world.save(saved);
        saved.snapshot = sent(saved.snapshot);
        elsewhere.restore(saved);
        Log here;
        Log there;
        world.play(100 + round, 1 + static_cast<int>(round % 12), here);
        elsewhere.play(100 + round, 1 + static_cast<int>(round % 12), there);
        ASSERT_EQ(here, there);
    }
}

class GridSnapshotPlays : public testing::TestWithParam<Play> {};

TEST_P(GridSnapshotPlays, HaveTheSameResultsAgainInSinglePrecision) {
    expectTheSameAgain<float>(GetParam());
}
TEST_P(GridSnapshotPlays, HaveTheSameResultsAgainInDoublePrecision) {
    expectTheSameAgain<double>(GetParam());
}
TEST_P(GridSnapshotPlays, HaveTheSameResultsWhereTheyAreSentInSinglePrecision) {
    expectTheSameWhereItIsSent<float>(GetParam());
}
TEST_P(GridSnapshotPlays, HaveTheSameResultsWhereTheyAreSentInDoublePrecision) {
    expectTheSameWhereItIsSent<double>(GetParam());
}
INSTANTIATE_TEST_SUITE_P(All, GridSnapshotPlays, testing::ValuesIn(plays()),
                         [](const auto& play) { return play.param.name; });

TEST(GridSnapshot, GoesBackEightFramesInEachFrameAsIfItHadNeverGoneBack) {
    const Play play{"Netcode", 300, 0.3, 0.3, 12, 0.2, 0.05};
    World<float> straight(play, 5);
    World<float> rolled(play, 5);
    std::vector<World<float>::Saved> ring(8);
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

/// A world of the play, two states of it, and what the second one answers.
struct BetweenTwoStates {
    BetweenTwoStates() : world({"Any", 200, 0.5, 0.5, 12, 0.3, 0.1, 0.1}, 3) {
        Log log;
        world.play(1, 20, log);
        world.save(before);
        world.play(2, 20, log);
        world.save(after);
    }
    [[nodiscard]] Log answers() {
        Log log;
        world.play(9, 3, log);
        return log;
    }
    World<float> world;
    World<float>::Saved before;
    World<float>::Saved after;
};

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
    World<float> world({"Steady", 300, 0.5, 0.01}, 3);
    World<float>::Saved saved;
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
    World<double> one(play, 3);
    World<double> other(play, 4);
    Log log;
    one.play(1, 20, log);
    other.play(2, 5, log);
    World<double>::Saved saved;
    one.save(saved);
    other.restore(saved);
    Log ofOne;
    Log ofOther;
    one.play(3, 10, ofOne);
    other.play(3, 10, ofOther);
    EXPECT_EQ(ofOne, ofOther);
    EXPECT_NE(one.grid.populationNumber(), other.grid.populationNumber());
}

TEST(GridSnapshot, RefusesBytesThatAreTornOrChanged) {
    BetweenTwoStates between;
    std::vector<std::byte> bytes;
    between.before.snapshot.write(bytes);
    GridSnapshot<float> snapshot;
    EXPECT_EQ(snapshot.read({}), "The bytes are not a snapshot of a grid.");
    std::vector<std::byte> other = bytes;
    other.pop_back();
    EXPECT_NE(snapshot.read(other).find("were written"), std::string::npos);
    other = bytes;
    other[bytes.size() / 2] ^= std::byte{1};
    EXPECT_EQ(snapshot.read(other),
              "The bytes of a snapshot of a grid have changed: their checksum is wrong.");
    other = bytes;
    other[8] = std::byte{9};
    EXPECT_EQ(snapshot.read(other),
              "The bytes are a snapshot of a grid of version 9; this "
              "library reads version 1.");
    GridSnapshot<double> ofDouble;
    EXPECT_EQ(ofDouble.read(bytes), "The bytes are a snapshot of a grid of the other precision.");
    EXPECT_TRUE(snapshot.isEmpty());
    EXPECT_EQ(snapshot.read(bytes), "");
}

TEST(GridSnapshot, IsSoundOrRefusedWhateverItsBytesAre) {
    const CaughtMessages messages;
    Random random(11);
    int read = 0;
    for (const Play& play : plays()) {
        World<float> world(play, 3);
        Log log;
        world.notesCosts = false;
        world.play(1, 20, log);
        World<float>::Saved saved;
        world.save(saved);
        std::vector<std::byte> bytes;
        saved.snapshot.write(bytes);
        for (int i = 0; i < 400; ++i) {
            GridSnapshot<float> snapshot;
            std::vector<std::byte> forged = bytes;
            forgeBytes(forged, random);
            if (snapshot.read(forged).empty()) {
                World<float> other({play.name, 0, play.moving, play.step, play.extent, play.refused,
                                    0, 0, play.hasPairs, true, play.config},
                                   1);
                const bool fits = play.hasPairs ? snapshot.faultFor(*other.pairs).empty()
                                                : snapshot.faultFor(other.grid).empty();
                if (!fits) {
                    continue;
                }
                ++read;
                if (play.hasPairs) {
                    snapshot.restore(*other.pairs);
                } else {
                    snapshot.restore(other.grid);
                }
                EXPECT_EQ(other.grid.validate(), "");
                other.update(log);  // and validates
                other.update(log);
            }
        }
    }
    EXPECT_GT(read, 100);
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
