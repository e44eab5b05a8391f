// SPDX-License-Identifier: Zlib

// Snapshots of grids as bytes: they have the same results where they are read, and no bytes break anything.

#include <broadphase/grid_snapshot.hpp>
#include <broadphase/sweeps.hpp>

#include <tests/broadphase/played_grid.hpp>
#include <tests/support/forged_bytes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace hashphase::test {
namespace {

Aabb<float> unitBox(double x) {
    return makeBox<float>(x, 0, 0, x + 1, 1, 1);
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
    PlayedGrid<Scalar> world(play, 7);
    PlayedGrid<Scalar> elsewhere(play, 8);
    Log log;
    world.notesCosts = elsewhere.notesCosts = false;
    world.play(1, 30, log);
    for (std::uint64_t round = 0; round < 24; ++round) {
        SCOPED_TRACE(round);
        typename PlayedGrid<Scalar>::Saved saved;
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

class GridSnapshotBytes : public testing::TestWithParam<Play> {};

TEST_P(GridSnapshotBytes, HoldAllThatMattersInSinglePrecision) {
    expectTheSameWhereItIsSent<float>(GetParam());
}
TEST_P(GridSnapshotBytes, HoldAllThatMattersInDoublePrecision) {
    expectTheSameWhereItIsSent<double>(GetParam());
}
INSTANTIATE_TEST_SUITE_P(All, GridSnapshotBytes, testing::ValuesIn(plays()),
                         [](const auto& play) { return play.param.name; });

/// Saves, sends and restores elsewhere; then both report the same.
void expectTheSamePairsWhereTheyAreSent(Pairs<float>& pairs) {
    GridSnapshot<float> snapshot;
    snapshot.save(pairs);
    Grid<float> grid(pairs.grid().store().config);
    Sweeps<float> sweeps(grid);
    Pairs<float> other(grid, pairs.sweeps() != nullptr ? &sweeps : nullptr);
    const GridSnapshot<float> received = sent(snapshot);
    ASSERT_EQ(received.faultFor(other), "");
    received.restore(other);
    EXPECT_EQ(other.count(), pairs.count());
    EXPECT_EQ(grid.validate(), "");
    for (int i = 0; i < 2; ++i) {
        const PairChanges there = other.update();
        const PairChanges here = pairs.update();
        EXPECT_TRUE(std::ranges::equal(there.born, here.born));
        EXPECT_TRUE(std::ranges::equal(there.died, here.died));
        EXPECT_EQ(other.validate(), "");
    }
    EXPECT_EQ(grid.add(unitBox(50)), pairs.grid().add(unitBox(50)));
}

TEST(GridSnapshotBytes, OfAGridWhoseOldProxiesHaveLowerGenerationsThanNewOnesAreRead) {
    Grid<float> grid;
    static_cast<void>(grid.add(unitBox(0)));
    grid.remove(grid.add(unitBox(1)));
    grid.update();
    grid.releaseUnusedMemory();
    ASSERT_EQ(grid.indexLimit(), 1U);
    Pairs<float> pairs(grid);
    expectTheSamePairsWhereTheyAreSent(pairs);
}

TEST(GridSnapshotBytes, OfIgnoredPairsOfRemovedProxiesAreRead) {
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId a = grid.add(unitBox(0));
    const ProxyId b = grid.add(unitBox(0));
    const ProxyId c = grid.add(unitBox(0));
    static_cast<void>(pairs.ignore({a, b}));
    static_cast<void>(pairs.ignore({a, c}));
    static_cast<void>(pairs.update());
    grid.remove(c);
    static_cast<void>(pairs.update());
    grid.releaseUnusedMemory();
    ASSERT_EQ(grid.indexLimit(), 2U);
    expectTheSamePairsWhereTheyAreSent(pairs);
    EXPECT_EQ(pairs.count(), 0U);
}

TEST(GridSnapshotBytes, OfContactsOfSweepsThatAreGoneAreRead) {
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    sweeps.set(grid.add(unitBox(0)), {10, 0, 0});
    static_cast<void>(grid.add(unitBox(5)));
    ASSERT_EQ(pairs.update().born.size(), 1U);
    pairs.setSweeps(nullptr);
    expectTheSamePairsWhereTheyAreSent(pairs);
    EXPECT_EQ(pairs.count(), 0U);
}

// The one that sweeps is new, or stood at the last update.
TEST(GridSnapshotBytes, AfterAnUpdateThatFailedAsASweepBeganAreRead) {
    for (const bool isNew : {true, false}) {
        Grid<float> grid;
        Sweeps<float> sweeps(grid);
        Pairs<float> pairs(grid, &sweeps);
        static_cast<void>(grid.add(unitBox(5)));
        static_cast<void>(grid.add(unitBox(0.5)));
        const ProxyId sweeper = isNew ? ProxyId{} : grid.add(unitBox(0));
        static_cast<void>(pairs.update());
        sweeps.set(isNew ? grid.add(unitBox(0)) : sweeper, {10, 0, 0});
        const auto fail = [](ProxyId, ProxyId) -> bool { throw std::runtime_error("no answer"); };
        EXPECT_THROW(static_cast<void>(pairs.update(fail)), std::runtime_error);
        expectTheSamePairsWhereTheyAreSent(pairs);
        EXPECT_EQ(pairs.count(), 2U);
    }
}

TEST(GridSnapshot, RefusesBytesThatAreTornOrChanged) {
    BetweenTwoStates between;
    std::vector<std::byte> bytes;
    between.before.snapshot.write(bytes);
    GridSnapshot<float> snapshot;
    EXPECT_EQ(snapshot.read({}),
              "The bytes are not a snapshot of a grid. Pass bytes that write() made.");
    std::vector<std::byte> other = bytes;
    other.pop_back();
    EXPECT_NE(snapshot.read(other).find("were written. Pass all of them, and no others."),
              std::string::npos);
    other = bytes;
    other[bytes.size() / 2] ^= std::byte{1};
    EXPECT_EQ(snapshot.read(other),
              "The bytes of a snapshot of a grid are damaged: their checksum is wrong. Read or "
              "receive them again.");
    other = bytes;
    other[8] = std::byte{9};
    EXPECT_EQ(snapshot.read(other),
              "The bytes are a snapshot of a grid of version 9, but this library reads version 1. "
              "Use the same version of hashphase to write and to read.");
    GridSnapshot<double> ofDouble;
    EXPECT_EQ(ofDouble.read(bytes),
              "The bytes are a snapshot of a grid of the other precision. Read them with the "
              "Scalar (float or double) that wrote them.");
    EXPECT_TRUE(snapshot.isEmpty());
    EXPECT_EQ(snapshot.read(bytes), "");
}

TEST(GridSnapshot, IsSoundOrRefusedWhateverItsBytesAre) {
    const CaughtMessages messages;
    Random random(11);
    int read = 0;
    for (const Play& play : plays()) {
        PlayedGrid<float> world(play, 3);
        Log log;
        world.notesCosts = false;
        world.play(1, 20, log);
        PlayedGrid<float>::Saved saved;
        world.save(saved);
        std::vector<std::byte> bytes;
        saved.snapshot.write(bytes);
        for (int i = 0; i < 400; ++i) {
            GridSnapshot<float> snapshot;
            std::vector<std::byte> forged = bytes;
            forgeBytes(forged, random);
            if (snapshot.read(forged).empty()) {
                PlayedGrid<float> other({play.name, 0, play.moving, play.step, play.extent,
                                         play.refused, 0, 0, play.hasPairs, true, play.config},
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

}  // namespace
}  // namespace hashphase::test
