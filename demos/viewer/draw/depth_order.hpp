// SPDX-License-Identifier: Zlib
#pragma once

// Things by their distance, the farthest first: what has soft edges is painted over what lies
// behind it. Or, by the inverse of it, the nearest first: what is hidden costs little.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::demos {

/// A radix sort that keeps its memory from frame to frame. Depths that differ by less than one part
/// in 8,000 count as equal; equal ones stay in the order in which they came.
class DepthOrder {
public:
    void clear() { entries_.clear(); }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Something so far in front of the eye; its `depth` is any positive number, its `index` the caller's.
    void add(float depth, std::uint32_t index) {
        // The bits of positive floats are in the order of the floats; inverted, the farthest come first.
        entries_.push_back({~std::bit_cast<std::uint32_t>(depth) >> kDroppedBits, index});
    }

    /// Writes all that were added since clear(), the farthest first and each so many times in a row;
    /// `to` has just room for them.
    template <typename Thing>
    void write(std::span<const Thing> things, std::span<Thing> to, std::size_t copies = 1) {
        sorted_.resize(entries_.size());
        sortByDigit(entries_, sorted_, 0);
        sortByDigit(sorted_, entries_, kDigitBits);
        auto next = to.begin();
        for (const Entry& entry : entries_) {
            next = std::fill_n(next, copies, things[entry.index]);
        }
    }

private:
    struct Entry {
        std::uint32_t key;
        std::uint32_t index;
    };

    static constexpr std::uint32_t kDigitBits = 11;
    static constexpr std::uint32_t kDroppedBits = 32 - 2 * kDigitBits;  // of a float's last ones

    static void sortByDigit(const std::vector<Entry>& from, std::vector<Entry>& to,
                            std::uint32_t shift) {
        constexpr std::uint32_t kDigits = 1U << kDigitBits;
        const auto digit = [shift](const Entry& entry) {
            return (entry.key >> shift) & (kDigits - 1);
        };
        std::array<std::uint32_t, kDigits> places{};
        for (const Entry& entry : from) {
            ++places[digit(entry)];
        }
        std::uint32_t next = 0;
        for (std::uint32_t& place : places) {
            next += std::exchange(place, next);
        }
        for (const Entry& entry : from) {
            to[places[digit(entry)]++] = entry;
        }
    }

    std::vector<Entry> entries_;
    std::vector<Entry> sorted_;
};

}  // namespace hashphase::demos
