// SPDX-License-Identifier: Zlib
#pragma once

// A radar: counts the proxies of each group in coarse cells (paper, "condensed view of a section of the domain").
//
// Counted   A proxy counts once, in the cell that contains its position (position_region.hpp). A position on the
//           border of two cells belongs to the cell with the larger index.
// Threads   For scan(), the thread rules of grid queries hold (grid.hpp). During scan(), no other thread may use this
//           object.
// Bad data  All counts are 0 if the cell size, centre or heading is not finite, or the cell size is not positive.
// Misuse    Asserted: a scan has at most kMostCounts counts.

#include <broadphase/grid.hpp>
#include <broadphase/up_axis.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace hashphase {

/// The part of space that a radar scans. Without a heading, column indices grow along the first axis that is not up,
/// and row indices along the second such axis: along x and z if y is up.
template <class Scalar>
struct RadarWindow {
    Vector3<Scalar> center = Vector3<Scalar>::Zero();  ///< [m]
    Scalar cellSize = 10;                              ///< edge length of the coarse cells [m]
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t layers = 0;  ///< number of cells along the up axis; 0: one layer for all heights
    UpAxis up = UpAxis::y;

    /// If `heading` is unset, cell borders are at multiples of `cellSize`. If no proxy moves, counts do not change
    /// while the centre moves within a cell, or if you shift the grid's origin and the centre together by a multiple
    /// of `cellSize`. The first column is columns / 2 cells (rounded down) before the cell that contains the centre.
    /// The same rule holds for rows and layers.
    ///
    /// A heading [rad] turns the window about the up axis, and the middle of the window is exactly at `center`. In
    /// coordinates (column axis, row axis), row indices grow along (sin, cos) of the heading, column indices along
    /// (cos, -sin).
    std::optional<Scalar> heading = std::nullopt;
};

/// Returns the group of a proxy. The proxy counts only if its group is less than `groupCount`.
using RadarGroups = FunctionRef<std::uint32_t(ProxyId)>;

/// Counts the proxies of each cell and group. Reuses its memory: allocates only if a frame needs more than before.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Radar {
public:
    static constexpr std::size_t kMostCounts = std::size_t{1} << 28;

    /// Counts the proxies in the window. Returns the counts as an array [group][layer][row][column]. If `layers` is
    /// 0, there is one layer. The span is valid until the next scan(). Asserted: `groupOf` does not call scan().
    /// Cost: one Grid::visit() of the window, and O(counts).
    std::span<const std::uint32_t> scan(const Grid<Scalar>& grid, const RadarWindow<Scalar>& window,
                                        std::uint32_t groupCount, RadarGroups groupOf) &;

    /// Cost of the last scan(). Its `hits` are boxes that touch the bounding box of the window.
    [[nodiscard]] const QueryCost& lastCost() const noexcept { return cost_; }

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + counts_.capacity() * sizeof(std::uint32_t);
    }

private:
    std::vector<std::uint32_t> counts_;
    QueryCost cost_;
};

extern template class Radar<float>;
extern template class Radar<double>;

}  // namespace hashphase
