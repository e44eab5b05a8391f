// SPDX-License-Identifier: Zlib
#include <demos/compare/heap_meter.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace hashphase::demos {
namespace {

TEST(HeapMeter, AddsUpTheGrowthAndKnowsNothingWhereMoreIsFreedThanTaken) {
    if (!heapBytes()) {
        GTEST_SKIP() << "this C library does not tell";
    }
    constexpr std::size_t kBytes = 1 << 22;
    std::vector<char> before(kBytes, 'a');
    std::vector<char> within;
    HeapMeter meter;
    EXPECT_EQ(meter.bytes(), 0);
    {
        const HeapScope scope(meter);
        within.assign(kBytes, before.back());
    }
    EXPECT_GE(meter.bytes().value(), static_cast<std::int64_t>(kBytes));
    {
        const HeapScope scope(meter);
        std::vector<char>().swap(within);
        std::vector<char>().swap(before);
    }
    EXPECT_EQ(meter.bytes(), std::nullopt);
}

}  // namespace
}  // namespace hashphase::demos
