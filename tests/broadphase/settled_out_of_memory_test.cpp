// SPDX-License-Identifier: Zlib

// Memory runs out where boxes settle, move within their slack and leave it, and where few are compared.

#include <tests/broadphase/failing_world.hpp>
#include <tests/support/fill_table.hpp>
#include <tests/support/threaded_for.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace hashphase::test {
namespace {

TEST_F(OutOfMemory, AnUpdateInWhichBoxesSettleIsRepeated) {
    const auto settle = [](FailingWorld& world) {
        playInWant(world, 60, [](FailingWorld& trembling, int) { trembling.tremble(kStanding); });
        const WorkingAllocations lifted;  // for messages
        EXPECT_GT(world.pairs.lastCost().grid.resting, 80U);
    };
    for (const auto slack : {std::optional<double>(), std::optional<double>(0.2)}) {
        const auto make = [=] {
            auto world = std::make_unique<FailingWorld>(90, GridConfig{.slack = slack}, kInRoom);
            world->update();
            return world;
        };
        expectGoesOn(80, make, settle);
    }
}

// Pairs of many turn, or of few, on this thread or on some.
TEST_F(OutOfMemory, AnUpdateInWhichSettledBoxesMoveIsRepeated) {
    ThreadedFor threads(3, 0x5eed0703);
    for (const ParallelFor parallelFor : {ParallelFor(serialFor), ParallelFor(threads)}) {
        for (const std::size_t count : {std::size_t{84}, std::size_t{9}}) {
            const auto tremble = [=](FailingWorld& world) {
                playInWant(
                    world, 2,
                    [=](FailingWorld& moved, int) {
                        moved.pairs.releaseUnusedMemory();  // or the update would take none
                        moved.tremble(kStanding, kStanding + count, kTrembling);
                    },
                    parallelFor);
                const WorkingAllocations lifted;
                EXPECT_EQ(world.pairs.lastCost().grid.changed, count);
                EXPECT_GE(world.pairs.lastCost().grid.resting, 84U);
            };
            expectGoesOn(
                50, [] { return settledRun(); }, tremble, checkTremblingGoesOn);
        }
    }
}

// Everyone may meet everyone, which are candidates enough for two parts.
TEST_F(OutOfMemory, AnUpdateOfACrowdThatHasSettledIsRepeated) {
    ThreadedFor threads(3, 0x5eed0704);
    const auto crowd = [] { return settledRun(131, boxesIn<float>(-0.6, 0.6, 0.5, 1)); };
    const std::size_t fewest = demos::hasThreads() ? 30 : 20;  // a thread takes memory, too
    expectGoesOn(fewest, crowd, [&](FailingWorld& world) {
        updatePairsInWant(world, threads);
        const WorkingAllocations lifted;
        EXPECT_GT(world.pairs.lastCost().pairsWatched, 8192U);
        EXPECT_LE(world.pairs.lastCost().grid.filed, kStanding);
    });
}

TEST_F(OutOfMemory, AnUpdateInWhichSettledBoxesLeaveIsRepeated) {
    const auto leave = [](FailingWorld& world) {
        playInWant(world, 3, [](FailingWorld& moved, int frame) {
            moved.tremble(kStanding, moved.proxies.size(), kTrembling);
            moved.moveSome(3 + static_cast<std::size_t>(frame));
            moved.removeSome(13);
        });
    };
    expectGoesOn(
        50, [] { return settledRun(); }, leave, checkTremblingGoesOn);
}

TEST_F(OutOfMemory, ATableThatSettlesIsFiledOrEmpty) {
    struct Settling : FilledTable<float> {
        bool isSettled = false;
    };
    const std::size_t failures = runOutOfMemory(
        [] {
            auto settling = std::make_unique<Settling>();
            Random random(7);
            settling->build(drawBoxes<float>(random, 90, kInRoom));
            return settling;
        },
        [](Settling& settling) {
            settling.table.settle();
            settling.isSettled = true;
        },
        [](Settling& settling, std::size_t) {
            EXPECT_EQ(settling.table.isSettled(), settling.isSettled);
            EXPECT_EQ(settling.table.size(), settling.isSettled ? 90U : 0U);
            EXPECT_EQ(settling.table.validate(), "");
        });
    EXPECT_GE(failures, 7U);
}

// Which takes memory where it may, and throws nothing. The second time, all that it takes has been given back.
TEST_F(OutOfMemory, GivingBackMemoryWakesWhatHasSettled) {
    const auto release = [](FailingWorld& world) {
        world.grid.releaseUnusedMemory();
        world.pairs.releaseUnusedMemory();
        {
            const WorkingAllocations lifted;
            world.moveTo(0, world.draw(world.random));
        }
        world.grid.releaseUnusedMemory();
    };
    const auto releaseAndUpdate = [&](FailingWorld& world) {
        release(world);
        updatePairsInWant(world);
    };
    expectGoesOn(
        80, [] { return settledRun(); }, releaseAndUpdate, checkTremblingGoesOn);
    for (std::size_t n = 0; n < 60; ++n) {
        SCOPED_TRACE("after " + std::to_string(n) + " allocations");
        const std::unique_ptr<FailingWorld> world = settledRun();
        {
            const FailingAllocations failing(n);
            release(*world);
        }
        checkTremblingGoesOn(*world, n);
    }
}

// Which are compared and not filed, become too many for that, and few again.
TEST_F(OutOfMemory, AnUpdateOfFewBoxesIsRepeated) {
    const auto make = [] {
        auto world = std::make_unique<FailingWorld>(20, GridConfig{}, kInRoom);
        world->update();
        return world;
    };
    std::size_t comparedCount = 0;
    expectGoesOn(80, make, [&](FailingWorld& world) {
        playInWant(world, 12, [&](FailingWorld& moved, int frame) {
            comparedCount += moved.pairs.lastCost().grid.filed == 0 ? 1 : 0;
            if (frame % 2 == 0) {
                moved.pairs.releaseUnusedMemory();
            }
            if (frame == 4) {
                moved.addSome(8);
            }
            if (frame == 8) {
                moved.removeSome(2);
            }
            moved.moveSome(1);
        });
    });
    EXPECT_GT(comparedCount, 40U);
}

}  // namespace
}  // namespace hashphase::test
