// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>
#include <integration/tbb/tbb_parallel_for.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace hashphase::test {
namespace {

TEST(TbbFor, RunsEveryIterationOnce) {
    for (const std::size_t count : {0U, 1U, 7U, 1000U, 100'000U}) {
        std::vector<std::atomic<int>> times(count);
        tbbFor(count, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                ++times[i];
            }
        });
        EXPECT_TRUE(std::ranges::all_of(times, [](const auto& n) { return n == 1; })) << count;
    }
}

TEST(TbbFor, FindsThePairsThatOneThreadFinds) {
    Random random(0x5eed0801);
    Grid<float> serialGrid;
    Pairs<float> serial(serialGrid);
    Grid<float> parallelGrid;
    Pairs<float> parallel(parallelGrid);
    std::vector<ProxyId> ids;
    std::vector<Aabb<float>> boxes;
    for (int i = 0; i < 20000; ++i) {
        boxes.push_back(boxAround<float>(random.pointIn(0, 60), {0.5, 0.5, 0.5}));
        ids.push_back(serialGrid.add(boxes.back()));
        static_cast<void>(parallelGrid.add(boxes.back()));
    }
    const auto acceptAll = [](ProxyId, ProxyId) { return true; };
    for (int frame = 0; frame < 5; ++frame) {
        const PairChanges expected = serial.update(acceptAll);
        const PairChanges actual = parallel.update(acceptAll, tbbFor);
        ASSERT_TRUE(std::ranges::equal(expected.born, actual.born));
        ASSERT_TRUE(std::ranges::equal(expected.died, actual.died));
        ASSERT_GT(expected.born.size(), 500U);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            boxes[i] = shifted(random, boxes[i], 0.3);
            serialGrid.move(ids[i], boxes[i]);
            parallelGrid.move(ids[i], boxes[i]);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
