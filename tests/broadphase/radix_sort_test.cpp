// SPDX-License-Identifier: Zlib
#include <broadphase/core/radix_sort.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hashphase::detail {
namespace {

TEST(RadixSort, SortsAsComparisonsDo) {
    test::Random random(0x5eed0601);
    std::vector<std::uint64_t> scratch;
    for (const std::uint32_t bound : {1U, 2U, 300U, 2048U, 2049U, 100'000U, 1U << 31, ~0U}) {
        for (const std::size_t count : {0, 1, 2, 255, 256, 257, 5000}) {
            std::vector<std::uint64_t> keys;
            for (std::size_t i = 0; i < count; ++i) {
                keys.push_back(std::uint64_t{random.below(bound)} << 32 | random.below(bound));
            }
            std::vector<std::uint64_t> expected = keys;
            std::sort(expected.begin(), expected.end());
            radixSort(keys, bound, scratch);
            ASSERT_EQ(keys, expected) << count << " keys below " << bound;
        }
    }
}

}  // namespace
}  // namespace hashphase::detail
