// SPDX-License-Identifier: Zlib
#pragma once

// Things by their distance, the farthest first: what has soft edges is painted over what lies
// behind it. Or, by the inverse of it, the nearest first: what is hidden costs little.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

/// A radix sort that keeps its memory from frame to frame. Depths that differ by less than one part
/// in 8,000 count as equal; equal ones stay in the order in which they came.
class DepthOrder {
public:
    void clear() { entries_.clear(); }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Something so far in front of the eye; its `depth` is any positive number, its `index` the caller's.
    void add(float depth, std::uint32_t index);

    /// Writes all that were added since clear(), the farthest first and each so many times in a row;
    /// `to` has just room for them.
    template <typename Thing>
    void write(std::span<const Thing> things, std::span<Thing> to, std::size_t copies = 1) {
        auto next = to.begin();
        for (const Entry& entry : sort()) {
            next = std::fill_n(next, copies, things[entry.index]);
        }
    }

    struct Entry {
        std::uint32_t key;
        std::uint32_t index;
    };

private:
    [[nodiscard]] std::span<const Entry> sort();

    std::vector<Entry> entries_;
    std::vector<Entry> sorted_;
};

}  // namespace hashphase::demos
