// SPDX-License-Identifier: Zlib
#pragma once

// Sorts pairs of small numbers by their digits: linear where comparing them would mispredict a
// branch at every second step. After Knuth, "The Art of Computer Programming" 3, 5.2.5, algorithm R.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hashphase::detail {

/// Sorts keys of the form high << 32 | low, both halves below `bound`, ascending. `scratch` is
/// overwritten. Cost: linear, some 3 ns a key for each eleven bits of the two halves closed up.
inline void radixSort(std::vector<std::uint64_t>& keys, std::uint32_t bound,
                      std::vector<std::uint64_t>& scratch) {
    constexpr std::size_t kWorthIt = 256;
    constexpr std::size_t kMost = 0xffffffff;  // that can be counted
    if (keys.size() < kWorthIt || keys.size() > kMost) {
        std::sort(keys.begin(), keys.end());
        return;
    }
    constexpr unsigned kDigitBits = 11;
    constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
    const auto bits = 32 - static_cast<unsigned>(std::countl_zero(bound));
    scratch.resize(keys.size());
    std::array<std::uint32_t, kDigits> start;
    const auto sortBy = [&](unsigned shift) {
        const auto digit = [shift, bits](std::uint64_t key) {
            const std::uint64_t closedUp = (key >> 32) << bits | (key & 0xffffffff);
            return (closedUp >> shift) & (kDigits - 1);
        };
        start.fill(0);
        for (const std::uint64_t key : keys) {
            ++start[digit(key)];
        }
        std::uint32_t sum = 0;
        for (std::uint32_t& count : start) {
            sum += std::exchange(count, sum);
        }
        for (const std::uint64_t key : keys) {
            scratch[start[digit(key)]++] = key;
        }
        keys.swap(scratch);
    };
    for (unsigned shift = 0; shift < 2 * bits; shift += kDigitBits) {
        sortBy(shift);
    }
}

}  // namespace hashphase::detail
