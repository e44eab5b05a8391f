// SPDX-License-Identifier: Zlib
#include <broadphase/core/first_exception.hpp>
#include <tests/integration/bullet/boxes.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace hashphase::test {
namespace {

TEST(Threads, GiveTheSamePairsInTheSameOrder) {
    ThreadedFor threadedFor(3, 0x5eed0902);
    SpatialHashConfig config;
    config.parallelFor = [&](std::size_t count, std::size_t grain, LoopBody body) {
        threadedFor(count, grain, body);
    };
    expectPairsOfSerialFrames(config, 4);
    EXPECT_GT(threadedFor.mostRanges(), 1U);
}

TEST(FirstException, IsKeptWhileOtherThreadsEnd) {
    ThreadedFor threadedFor(3, 0x5eed0903);
    std::vector<int> times(1000, 0);
    detail::FirstException exception;
    EXPECT_NO_THROW(exception.rethrow());
    threadedFor(times.size(), 16, [&](std::size_t first, std::size_t last) {
        const auto body = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                ++times[i];
            }
            throw std::runtime_error("as each part does");
        };
        exception.run(body, first, last);
    });
    EXPECT_THROW(exception.rethrow(), std::runtime_error);
    EXPECT_EQ(std::ranges::count(times, 1), 1000);
}

}  // namespace
}  // namespace hashphase::test
