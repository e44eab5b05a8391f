// SPDX-License-Identifier: Zlib
#pragma once

// How many bodies have their middle in each column of cells: the buckets of the paper's grid, seen from
// above.

#include <demos/viewer/stage/stage.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::demos {

struct CellLoads {
    /// As nobody has counted.
    CellLoads() = default;

    /// Counts the bodies of a grid in its finest cells, or in whole multiples of them where there would be
    /// more than kMostColumns of these along a side of the bounds. Cost: O(proxies + cells).
    CellLoads(const Grid<float>& grid, const Aabb<float>& bounds);

    [[nodiscard]] bool isEmpty() const noexcept { return counts.empty(); }

    /// Those in the column of cells at that place; 0 outside.
    [[nodiscard]] std::uint32_t at(float x, float z) const {
        const std::optional<std::size_t> cell = cellAt(x, z);
        return cell ? counts[*cell] : 0;
    }

    static constexpr std::uint32_t kMostColumns = 512;

    float cellSize = 1;
    Eigen::Vector2f corner = Eigen::Vector2f::Zero();
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<std::uint32_t> counts;  // row by row
    std::uint32_t largest = 0;
    /// A column that is as full as any is shown: the fullest, or of eight where none has as many.
    std::uint32_t full = 1;
    std::vector<std::uint8_t> shades;  // row by row, 255 for a full column

private:
    [[nodiscard]] std::optional<std::size_t> cellAt(float x, float z) const;
};

}  // namespace hashphase::demos
