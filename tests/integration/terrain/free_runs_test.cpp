// SPDX-License-Identifier: Zlib

// Free numbers in runs, beside a plain list of which numbers are free.

#include <integration/terrain/detail/free_runs.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hashphase::test {
namespace {

struct PlainNumbers {
    std::vector<bool> free;

    [[nodiscard]] bool hasAny(std::uint32_t first, std::uint32_t count) const {
        return std::any_of(free.begin() + first, free.begin() + first + count,
                           [](bool isFree) { return isFree; });
    }
    [[nodiscard]] std::uint32_t firstFit(std::uint32_t count) const {
        std::uint32_t first = 0;
        for (std::uint32_t i = 0; i < free.size() && i - first < count; ++i) {
            first = free[i] ? first : i + 1;
        }
        return first;
    }
    [[nodiscard]] std::size_t runCount() const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < free.size(); ++i) {
            count += free[i] && (i == 0 || !free[i - 1]) ? 1 : 0;
        }
        return count;
    }
};

TEST(FreeRuns, AreThoseOfAPlainList) {
    Random random(0x5eed2501);
    detail::FreeRuns runs;
    PlainNumbers plain;
    for (int step = 0; step < 20000; ++step) {
        const std::uint32_t end = static_cast<std::uint32_t>(plain.free.size());
        const std::uint32_t count = 1 + random.below(step % 1000 < 500 ? 4 : 9);
        if (end < 8 || random.chance(0.35)) {
            const std::uint32_t first = runs.firstFit(count, end);
            ASSERT_EQ(first, plain.firstFit(count));
            runs.take(first, count);
            plain.free.resize(std::max(end, first + count), false);
            std::fill_n(plain.free.begin() + first, count, false);
        } else {
            const std::uint32_t first = random.below(end);
            std::uint32_t given = std::min(count, end - first);
            ASSERT_EQ(runs.hasAny(first, given), plain.hasAny(first, given));
            while (plain.hasAny(first, given)) {
                --given;
            }
            runs.reserveOne();
            runs.free(first, given);
            std::fill_n(plain.free.begin() + first, given, true);
        }
        ASSERT_EQ(runs.size(), plain.runCount());
    }
    EXPECT_LT(plain.free.size(), 2000U);
}

TEST(FreeRuns, OfNoNumbersAreNone) {
    detail::FreeRuns runs;
    runs.reserveOne();
    runs.free(3, 0);
    EXPECT_EQ(runs.size(), 0U);
    runs.free(2, 4);
    EXPECT_FALSE(runs.hasAny(3, 0));
    EXPECT_EQ(runs.firstFit(0, 9), 2U);
    runs.take(2, 0);
    EXPECT_EQ(runs.firstFit(4, 9), 2U);
}

}  // namespace
}  // namespace hashphase::test
