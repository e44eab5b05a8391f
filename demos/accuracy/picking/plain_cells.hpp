// SPDX-License-Identifier: Zlib
#pragma once

// A plain map of cells of 1 m in space: each names every box that touches it. For experiments that
// compare ways through the cells, not maps.

#include <broadphase/aabb.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

using Cell = std::array<std::int64_t, 3>;

class PlainCells {
public:
    /// Boxes have their numbers. A flat map has one layer of cells, whatever y is.
    explicit PlainCells(std::span<const Aabb<float>> boxes, bool isFlat = false);

    [[nodiscard]] bool isFlat() const noexcept { return isFlat_; }

    /// The numbers of all boxes that touch the cell; y is 0 in a flat map.
    [[nodiscard]] std::span<const std::uint32_t> boxesIn(const Cell& cell) const;

private:
    struct Slot {
        Cell cell{};
        std::uint32_t begin = 0;
        std::uint32_t end = 0;  // begin where the slot is free
    };

    [[nodiscard]] std::size_t slotOf(const Cell& cell) const;

    bool isFlat_;
    std::vector<std::uint32_t> boxes_;  // cell by cell
    std::vector<Slot> slots_;           // open addressing; a power of two, at most half full
};

}  // namespace hashphase::demos
