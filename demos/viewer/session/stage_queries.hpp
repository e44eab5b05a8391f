// SPDX-License-Identifier: Zlib
#pragma once

// What is asked about a stage: one body, all pairs, and where many bodies are.

#include <demos/viewer/stage/stage.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// What there is to know about one body.
struct InfoCard {
    std::uint32_t index = 0;
    StageBody body;
    std::array<std::int64_t, 3> cell{};  // of its middle
    std::uint64_t load = 0;              // bodies whose boxes touch that cell
    std::uint64_t neighbours = 0;  // other bodies whose boxes are within the radius of its middle
    std::uint64_t candidates = 0;  // other bodies whose boxes touch its box
    float radius = 0;              // [m]
};

/// Asks the grid about the body, which is there. Cost: three small queries.
[[nodiscard]] InfoCard infoCard(const Stage& stage, const Grid<float>& grid, std::uint32_t index,
                                float radius);

/// The pairs that a stage's broadphase has found in the last frame, and the exact ones; all sorted.
struct PairCheck {
    std::vector<PairKey> exact;
    std::vector<PairKey> missing;  // overlap and are not listed: wrong answers
    std::vector<PairKey> extra;    // are listed and do not overlap: they cost time
};

/// Cost: the boxes are sorted along one axis.
[[nodiscard]] PairCheck checkPairs(const Stage& stage);

/// How many bodies have their middle in each column of cells: the buckets of the paper's grid, seen from above.
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
