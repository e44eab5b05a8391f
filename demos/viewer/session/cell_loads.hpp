// SPDX-License-Identifier: Zlib
#pragma once

// How many bodies have their middle in each column of cells: the buckets of the paper's grid, seen from
// above.

#include <demos/viewer/stage/stage.hpp>

#include <cstdint>
#include <vector>

namespace hashphase::demos {

class CellLoads {
public:
    /// Counts the bodies of a grid in its finest cells, or in whole multiples of them where there would be
    /// more than kMostColumns of these along a side of the bounds. Cost: O(proxies + cells).
    void count(const Grid<float>& grid, const Aabb<float>& bounds);

    /// Whether nobody has counted.
    [[nodiscard]] bool isEmpty() const noexcept { return counts_.empty(); }

    /// Those in the column of cells at that place; 0 outside.
    [[nodiscard]] std::uint32_t at(float x, float z) const;

    [[nodiscard]] float cellSize() const noexcept { return cellSize_; }
    [[nodiscard]] Eigen::Vector2f corner() const noexcept { return corner_; }
    [[nodiscard]] std::uint32_t columns() const noexcept { return columns_; }
    [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }
    [[nodiscard]] std::uint32_t largest() const noexcept { return largest_; }

    /// A column that is as full as any is shown: the fullest, or of eight where none has as many.
    [[nodiscard]] std::uint32_t full() const noexcept { return full_; }
    /// Row by row, 255 for a full column.
    [[nodiscard]] const std::vector<std::uint8_t>& shades() const noexcept { return shades_; }

    static constexpr std::uint32_t kMostColumns = 512;

private:
    float cellSize_ = 1;
    Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();
    std::uint32_t columns_ = 0;
    std::uint32_t rows_ = 0;
    std::uint32_t largest_ = 0;
    std::uint32_t full_ = 1;
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint8_t> shades_;
};

}  // namespace hashphase::demos
