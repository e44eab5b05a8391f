// SPDX-License-Identifier: Zlib

// An update gives the same on any number of threads.

#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
struct UpdatedWorld {
    Grid<Scalar> grid;
    Pairs<Scalar> pairs{grid};
    std::vector<ProxyId> ids;

    void apply(const std::vector<Aabb<Scalar>>& boxes) {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (i == ids.size()) {
                ids.push_back(grid.add(boxes[i]));
            } else {
                grid.move(ids[i], boxes[i]);
            }
        }
    }

    static bool accepts(ProxyId a, ProxyId b) { return (a.index + b.index) % 7 != 0; }
};

/// Two sizes, so that there are two levels, large enough for several ranges each.
template <class Scalar>
std::vector<Aabb<Scalar>> draw(std::size_t count, Random& random) {
    const double side = 2.2 * std::cbrt(static_cast<double>(count));
    std::vector<Aabb<Scalar>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const double half = i % 10 == 0 ? 2 : 0.5;
        boxes.push_back(boxAround<Scalar>(random.pointIn(0, side), {half, half, half}));
    }
    return boxes;
}

template <class Scalar>
class PairsOnThreads : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsOnThreads, Scalars);

TYPED_TEST(PairsOnThreads, AreTheSameOnAnyNumberOfThreads) {
    for (const std::size_t threadCount : {1, 2, 3, 8, 16}) {
        SCOPED_TRACE(testing::Message() << threadCount << " threads");
        Random random(0x5eed0701);
        ThreadedFor threadedFor(threadCount, 0x5eed0702);
        UpdatedWorld<TypeParam> serial;
        UpdatedWorld<TypeParam> parallel;
        std::vector<Aabb<TypeParam>> boxes = draw<TypeParam>(20000, random);
        std::size_t changes = 0;
        for (int frame = 0; frame < 14; ++frame) {
            serial.apply(boxes);
            parallel.apply(boxes);
            const PairChanges expected = serial.pairs.update(UpdatedWorld<TypeParam>::accepts);
            const PairChanges actual =
                parallel.pairs.update(UpdatedWorld<TypeParam>::accepts, threadedFor);
            ASSERT_TRUE(std::ranges::equal(expected.born, actual.born)) << "frame " << frame;
            ASSERT_TRUE(std::ranges::equal(expected.died, actual.died)) << "frame " << frame;
            ASSERT_EQ(serial.pairs.lastCost().boxesTested, parallel.pairs.lastCost().boxesTested);
            ASSERT_EQ(serial.pairs.lastCost().grid.resting, parallel.pairs.lastCost().grid.resting);
            changes += expected.born.size() + expected.died.size();
            // Half of them come to rest after a while.
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                if (frame < 2 || i % 2 == 0) {
                    boxes[i] = shifted(random, boxes[i], 0.3);
                }
            }
        }
        EXPECT_GT(changes, 10000U);
        EXPECT_GT(parallel.pairs.lastCost().grid.resting, 5000U);
        EXPECT_GT(threadedFor.mostRanges(), 4U);
        EXPECT_EQ(parallel.grid.validate(), "");
        EXPECT_EQ(parallel.pairs.validate(), "");
    }
}

TYPED_TEST(PairsOnThreads, OfAGridAloneAreFiledTheSame) {
    Random random(0x5eed0703);
    ThreadedFor threadedFor(4, 0x5eed0704);
    Grid<TypeParam> grid;
    for (const Aabb<TypeParam>& box : draw<TypeParam>(20000, random)) {
        static_cast<void>(grid.add(box));
    }
    EXPECT_EQ(grid.update(threadedFor).filed, 20000U);
    EXPECT_EQ(grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
