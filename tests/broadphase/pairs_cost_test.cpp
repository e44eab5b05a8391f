// SPDX-License-Identifier: Zlib

// What an update does follows what changed, counted rather than timed; and is the same on any number of threads.

#include <broadphase/pairs.hpp>
#include <tests/support/population.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace hashphase::test {
namespace {

/// Boxes of 1 to 2 m with some overlap, spread over a cube, and their pairs.
struct PairCosts : testing::Test {
    void addMany(std::uint32_t count) {
        boxes.addMany(count, boxesIn<float>(0., 2.5 * std::cbrt(count), 0.5, 1));
    }
    void nudge(std::size_t i, double step) {
        boxes.moveTo(i, shifted(boxes.random, boxes.proxies[i].box, step));
    }
    const PairCost& update() {
        changes = pairs.update();
        return pairs.lastCost();
    }

    Population<float> boxes;
    Pairs<float> pairs{boxes.grid};
    PairChanges changes;
};

TEST_F(PairCosts, OfAnUpdateAfterWhichNothingChangedIsZero) {
    addMany(3000);
    update();
    for (int i = 0; i < 20; ++i) {
        for (std::size_t k = 0; k < boxes.proxies.size(); ++k) {
            nudge(k, 0);
        }
        update();
        EXPECT_TRUE(changes.born.empty() && changes.died.empty());
        EXPECT_EQ(pairs.lastCost().grid.changed, 0U);
        EXPECT_EQ(pairs.lastCost().grid.filed, 0U);
        EXPECT_EQ(pairs.lastCost().boxesTested, 0U);
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
}

TEST_F(PairCosts, FollowsWhatMovesNotWhatExists) {
    constexpr std::uint32_t kCount = 20000;
    constexpr std::uint32_t kMoving = 50;
    addMany(kCount);
    for (int frame = 0; frame < 40; ++frame) {
        for (std::uint32_t i = 0; i < kMoving; ++i) {
            nudge(i * 397, 0.1);
        }
        const auto& cost = update();
        if (frame < 20) {
            continue;
        }
        EXPECT_EQ(cost.grid.changed, kMoving);
        EXPECT_LE(cost.grid.filed, 2 * kMoving);
        EXPECT_GE(cost.grid.resting, kCount - 2 * kMoving);
        // Some dozen neighbours each, where a search through all would be a million tests.
        EXPECT_LT(cost.boxesTested, 200 * kMoving);
        EXPECT_LT(cost.pairsWatched, 20 * kMoving);
    }
}

TEST_F(PairCosts, OfStaticProxiesEndsAfterTheSecondUpdate) {
    boxes.addMany(5000, cubesIn<float>(0, 50, 1), 1);
    boxes.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    update();
    for (int frame = 0; frame < 5; ++frame) {
        nudge(5000, 1);
        const auto& cost = update();
        EXPECT_EQ(cost.grid.changed, 1U);
        EXPECT_EQ(cost.grid.resting, 5000U);
        if (frame > 0) {
            EXPECT_EQ(cost.grid.filed, 1U);
            EXPECT_LT(cost.boxesTested, 500U);
        }
    }
}

TEST_F(PairCosts, CountsTheSearchOnBehalfOfProxiesThatWake) {
    boxes.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    boxes.addMany(500, [](Random&) { return makeBox<float>(0.5, 0, 0, 1, 1, 1); });
    boxes.add(makeBox<float>(-100, 0, 0, -99, 1, 1));
    for (int i = 0; i < 30; ++i) {
        boxes.moveTo(501, makeBox<float>(-100 - i, 0, 0, -99, 1, 1));
        update();
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
    boxes.moveTo(0, makeBox<float>(900, 0, 0, 901, 1, 1));  // to where nothing is
    EXPECT_GE(update().boxesTested, 500U);
    EXPECT_EQ(changes.died.size(), 500U);
}

// --- Threads -------------------------------------------------------------------------------------

template <class Scalar>
class PairsOnThreads : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsOnThreads, Scalars);

/// Two sizes, so that there are two levels, large enough for several ranges each.
template <class Scalar>
void addTwoSizes(Population<Scalar>& boxes, std::size_t count) {
    const double side = 2.2 * std::cbrt(static_cast<double>(count));
    boxes.addMany(count / 10, cubesIn<Scalar>(0., side, 2));
    boxes.addMany(count - count / 10, cubesIn<Scalar>(0., side, 0.5));
}

TYPED_TEST(PairsOnThreads, AreTheSameOnAnyNumberOfThreads) {
    const auto accepts = [](ProxyId a, ProxyId b) { return (a.index + b.index) % 7 != 0; };
    for (const std::size_t threadCount : {1, 2, 3, 8, 16}) {
        SCOPED_TRACE(testing::Message() << threadCount << " threads");
        ThreadedFor threadedFor(threadCount, 0x5eed0702);
        Population<TypeParam> serial;
        Population<TypeParam> parallel;
        Pairs<TypeParam> serialPairs(serial.grid);
        Pairs<TypeParam> parallelPairs(parallel.grid);
        addTwoSizes(serial, 20000);
        addTwoSizes(parallel, 20000);
        std::size_t changes = 0;
        for (int frame = 0; frame < 14; ++frame) {
            const PairChanges expected = serialPairs.update(accepts);
            const PairChanges actual = parallelPairs.update(accepts, threadedFor);
            ASSERT_TRUE(std::ranges::equal(expected.born, actual.born)) << "frame " << frame;
            ASSERT_TRUE(std::ranges::equal(expected.died, actual.died)) << "frame " << frame;
            ASSERT_EQ(serialPairs.lastCost().boxesTested, parallelPairs.lastCost().boxesTested);
            ASSERT_EQ(serialPairs.lastCost().grid.resting, parallelPairs.lastCost().grid.resting);
            changes += expected.born.size() + expected.died.size();
            // Half of them come to rest after a while.
            for (std::size_t i = 0; i < 20000; i += frame < 2 ? 1 : 2) {
                const auto box = shifted(serial.random, serial.proxies[i].box, 0.3);
                serial.moveTo(i, box);
                parallel.moveTo(i, box);
            }
        }
        EXPECT_GT(changes, 10000U);
        EXPECT_GT(parallelPairs.lastCost().grid.resting, 5000U);
        EXPECT_GT(threadedFor.mostRanges(), 4U);
        EXPECT_EQ(parallel.grid.validate(), "");
        EXPECT_EQ(parallelPairs.validate(), "");
    }
}

TYPED_TEST(PairsOnThreads, OfAGridAloneAreFiledTheSame) {
    ThreadedFor threadedFor(4, 0x5eed0704);
    Population<TypeParam> boxes;
    addTwoSizes(boxes, 20000);
    EXPECT_EQ(boxes.grid.update(threadedFor).filed, 20000U);
    EXPECT_EQ(boxes.grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
