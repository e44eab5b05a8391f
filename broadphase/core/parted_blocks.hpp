// SPDX-License-Identifier: Zlib
#pragma once

// Puts many numbers apart by parts, so that threads deal with a part each: a radix sort by one digit, after Knuth,
// "The Art of Computer Programming" 3, 5.2.5, of blocks each by itself.

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

class PartedBlocks {
public:
    static constexpr std::uint32_t kParts = 32;
    static constexpr std::size_t kBlock = 2048;  // numbers

    [[nodiscard]] static std::size_t blockCount(std::size_t count) noexcept {
        return (count + kBlock - 1) / kBlock;
    }

    /// So that resize() takes no memory.
    void reserve(std::size_t count) { ensureCapacity(starts_, blockCount(count)); }
    /// For numbers 0 to count - 1.
    void resize(std::size_t count) { starts_.resize(blockCount(count)); }

    /// Writes the numbers from `first`, a multiple of kBlock, to last - 1 into `order`, which begins with that of
    /// number 0, in blocks. partOf(number) is below kParts.
    template <class PartOf>
    void sort(std::size_t first, std::size_t last, const PartOf& partOf,
              std::uint32_t* order) noexcept {
        for (std::size_t begin = first; begin < last; begin += kBlock) {
            sortBlock(begin, std::min(begin + kBlock, last), partOf, order);
        }
    }

    /// Calls visit(first, last) for the places in `order` of the part's numbers in each block.
    template <class Visit>
    void forEachOf(std::size_t part, const Visit& visit) const {
        for (std::size_t block = 0; block < starts_.size(); ++block) {
            visit(block * kBlock + starts_[block][part], block * kBlock + starts_[block][part + 1]);
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return starts_.capacity() * sizeof(Starts);
    }

private:
    using Starts = std::array<std::uint16_t, kParts + 1>;

    template <class PartOf>
    void sortBlock(std::size_t first, std::size_t last, const PartOf& partOf,
                   std::uint32_t* order) noexcept {
        std::array<std::uint8_t, kBlock> parts;
        std::array<std::uint16_t, kParts> next{};
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t part = partOf(i);
            parts[i - first] = static_cast<std::uint8_t>(part);
            ++next[part];
        }
        Starts& starts = starts_[first / kBlock];
        std::uint16_t sum = 0;
        for (std::size_t part = 0; part < kParts; ++part) {
            starts[part] = sum;
            sum = static_cast<std::uint16_t>(sum + std::exchange(next[part], sum));
        }
        starts.back() = sum;
        for (std::size_t i = first; i < last; ++i) {
            order[first + next[parts[i - first]]++] = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<Starts> starts_;  // of each block's parts within it
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
