// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace hashphase::detail {

/// One level of a table: which entries it has, how coordinates become its cells, and how its rows
/// of cells become buckets.
template <class Scalar>
struct Level {
    std::array<Scalar, 3> origin{};
    std::array<Scalar, 3> inverseCellSize{};  // 0 along a flat axis, which has one cell: 0
    // Of boxes that are filed here; NaN, which nothing is below, where there are no cells.
    Scalar largestEdge = std::numeric_limits<Scalar>::quiet_NaN();
    // Between which coordinates the boxes lie, along flat axes.
    std::array<Scalar, 3> lowest{};
    std::array<Scalar, 3> highest{};
    std::uint32_t firstEntry = 0;
    std::uint32_t lastEntry = 0;  // one past
    std::uint32_t firstBucket = 0;
    std::uint32_t bucketCount = 1;
    // Every entry's cell lies from low to high. Of two levels of one cell size, a box is filed on
    // the dense one where its cell lies within. A level without cells is a plain list: it has one
    // bucket, and every walk reads it whole.
    Cell low{};
    Cell high{};
    bool hasCells = false;
    // A well-filled range of cells is numbered through (the paper's formula), with empty ones between
    // rows and between layers; else rows are hashed into a number of buckets that is a power of two.
    bool isDense = false;
    std::uint32_t strideY = 0;
    std::uint32_t strideZ = 0;
    std::uint32_t denseBase = 0;
    // Of the table's sorted buckets, those of this level.
    std::uint32_t firstSorted = 0;
    std::uint32_t sortedCount = 0;

    [[nodiscard]] std::uint32_t count() const noexcept { return lastEntry - firstEntry; }

    [[nodiscard]] std::int32_t cell(Scalar x, std::size_t axis) const noexcept {
        // Not 0 * infinity, along a flat axis.
        return inverseCellSize[axis] == 0 ? 0 : quantise(x, origin[axis], inverseCellSize[axis]);
    }

    /// Bucket of cell x = 0 of row (y, z), among the level's own; hashed ones before the modulo.
    [[nodiscard]] std::uint32_t rowBase(std::int32_t y, std::int32_t z) const noexcept {
        const auto row =
            static_cast<std::uint32_t>(y) * strideY + static_cast<std::uint32_t>(z) * strideZ;
        return isDense ? row + denseBase : mixRow(row);
    }

    /// Bucket of a cell from low to high, among the level's own.
    [[nodiscard]] std::uint32_t bucket(const Cell& cell) const noexcept {
        const std::uint32_t sum = rowBase(cell[1], cell[2]) + static_cast<std::uint32_t>(cell[0]);
        return isDense ? sum : sum & (bucketCount - 1);
    }
};

}  // namespace hashphase::detail
