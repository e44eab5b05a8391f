// SPDX-License-Identifier: Zlib
#pragma once

// Sorts pairs of small numbers by their digits: linear where comparing them would mispredict a
// branch at every second step. After Knuth, "The Art of Computer Programming" 3, 5.2.5, algorithm R. Many
// keys are put apart by their highest digit first, so that threads sort what is then in parts.

#include <broadphase/parallel_for.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Keys of the form high << 32 | low, both halves of so many bits, closed up.
struct ClosedUpKeys {
    unsigned bits;

    [[nodiscard]] std::size_t digit(std::uint64_t key, unsigned shift,
                                    std::size_t digits) const noexcept {
        const std::uint64_t closedUp = (key >> 32) << bits | (key & 0xffffffff);
        return static_cast<std::uint32_t>(closedUp >> shift) & (digits - 1);
    }
};

/// Sorts `count` keys by their lowest `bitCount` bits, with as many to put them meanwhile. Returns whether
/// they have ended up there.
inline bool sortByLowBits(std::uint64_t* keys, std::uint64_t* scratch, std::size_t count,
                          ClosedUpKeys closedUp, unsigned bitCount) noexcept {
    constexpr unsigned kMostBits = 11;
    const unsigned passes = (bitCount + kMostBits - 1) / kMostBits;
    const unsigned digitBits = passes > 0 ? (bitCount + passes - 1) / passes : 0;
    std::array<std::uint32_t, std::size_t{1} << kMostBits> start;
    bool isInScratch = false;
    for (unsigned shift = 0; shift < bitCount; shift += digitBits) {
        const std::size_t digits = std::size_t{1} << std::min(digitBits, bitCount - shift);
        std::fill_n(start.begin(), digits, 0);
        for (std::size_t i = 0; i < count; ++i) {
            ++start[closedUp.digit(keys[i], shift, digits)];
        }
        std::uint32_t sum = 0;
        for (std::size_t digit = 0; digit < digits; ++digit) {
            sum += std::exchange(start[digit], sum);
        }
        for (std::size_t i = 0; i < count; ++i) {
            scratch[start[closedUp.digit(keys[i], shift, digits)]++] = keys[i];
        }
        std::swap(keys, scratch);
        isInScratch = !isInScratch;
    }
    return isInScratch;
}

/// Sorts keys of the form high << 32 | low, both halves below `bound`, ascending. `scratch` is overwritten, and
/// takes as much memory. Cost: linear, some 3 ns a key for each eleven bits of the two halves closed up;
/// thousands are sorted on all threads, where there are some.
inline void radixSort(std::vector<std::uint64_t>& keys, std::uint32_t bound,
                      std::vector<std::uint64_t>& scratch, ParallelFor parallelFor = serialFor) {
    constexpr std::size_t kWorthIt = 256;
    constexpr std::size_t kMost = 0xffffffff;  // that can be counted
    constexpr unsigned kPartBits = 4;
    constexpr std::size_t kParts = std::size_t{1} << kPartBits;
    constexpr std::size_t kBlocks = 32;
    constexpr std::size_t kWorthParts = 4096;
    if (keys.size() < kWorthIt || keys.size() > kMost) {
        std::sort(keys.begin(), keys.end());
        return;
    }
    const ClosedUpKeys closedUp{32 - static_cast<unsigned>(std::countl_zero(bound))};
    const unsigned bitCount = 2 * closedUp.bits;
    const unsigned lowBits = bitCount - std::min(kPartBits, bitCount);
    const std::size_t blockSize = (keys.size() + kBlocks - 1) / kBlocks;
    scratch.resize(keys.size());
    const auto forEachOfBlock = [&](std::size_t block, const auto& visit) {
        const std::size_t end = std::min((block + 1) * blockSize, keys.size());
        for (std::size_t i = std::min(block * blockSize, end); i < end; ++i) {
            visit(keys[i], closedUp.digit(keys[i], lowBits, kParts));
        }
    };
    // Of each block's keys of each part; first how many there are, then where they begin.
    std::array<std::array<std::uint32_t, kParts>, kBlocks> start{};
    bool isParted = keys.size() >= kWorthParts;
    if (isParted) {
        parallelFor(kBlocks, 1, [&](std::size_t begin, std::size_t end) {
            if (end - begin == kBlocks) {
                isParted = false;  // one thread does it all
                return;
            }
            for (std::size_t block = begin; block < end; ++block) {
                forEachOfBlock(block,
                               [&](std::uint64_t, std::size_t part) { ++start[block][part]; });
            }
        });
    }
    if (!isParted) {
        if (sortByLowBits(keys.data(), scratch.data(), keys.size(), closedUp, bitCount)) {
            keys.swap(scratch);
        }
        return;
    }
    std::array<std::uint32_t, kParts + 1> firstOfPart{};
    std::uint32_t sum = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
        firstOfPart[part] = sum;
        for (auto& ofBlock : start) {
            sum += std::exchange(ofBlock[part], sum);
        }
    }
    firstOfPart[kParts] = sum;
    parallelFor(kBlocks, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            forEachOfBlock(block, [&](std::uint64_t key, std::size_t part) {
                scratch[start[block][part]++] = key;
            });
        }
    });
    parallelFor(kParts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            const std::uint32_t first = firstOfPart[part];
            const std::uint32_t count = firstOfPart[part + 1] - first;
            if (!sortByLowBits(scratch.data() + first, keys.data() + first, count, closedUp,
                               lowBits)) {
                std::copy_n(scratch.data() + first, count, keys.data() + first);
            }
        }
    });
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
