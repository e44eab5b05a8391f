// SPDX-License-Identifier: Zlib
#pragma once

// A radar: a condensed view of what is around, as counts in coarse cells by group (paper,
// "condensed view of a section of the domain").
//
// Counted   Each proxy once, in the cell of its position (position_region.hpp). A proxy outside the window,
//           or without a position, is not counted. Cells are half open: a border belongs only to the cell
//           above it.
// Threads   scan() reads the grid, as queries do, and needs this object for itself.
// Bad data  With a cell size that is 0 or less, NaN or infinite, or a centre or heading that is not finite,
//           all counts are 0.
// Misuse    More than kMostCounts counts are asserted.

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

/// Where a radar looks: columns along the first axis that is not up, rows along the second (x and
/// z, where up is y).
template <class Scalar>
struct RadarWindow {
    Vector3<Scalar> center = Vector3<Scalar>::Zero();  ///< [m]
    Scalar cellSize = 10;                              ///< edge of the coarse cells [m]
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t layers = 0;  ///< of cells, one above another; 0: one, of all heights
    UpAxis up = UpAxis::y;

    /// Without a heading, cells begin at multiples of their size: the counts of resting proxies do not
    /// flicker while the agent moves within its cell, nor when the origin is shifted by a multiple of their
    /// size. The window begins columns / 2 cells (integer division) before the cell of the centre; likewise
    /// rows and layers.
    ///
    /// With a heading [rad], the window is turned about the up axis and its middle is the centre, which lies
    /// between two columns where their number is even. Rows grow along (sin, cos) of the heading in the plane
    /// of (column axis, row axis), columns along (cos, -sin). Heading 0 looks along the row axis.
    std::optional<Scalar> heading = std::nullopt;
};

/// Returns the group of a proxy. A proxy whose group is not below the number of groups is not counted.
using RadarGroups = FunctionRef<std::uint32_t(ProxyId)>;

/// Counts proxies by cell and group. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Radar {
public:
    static constexpr std::size_t kMostCounts = std::size_t{1} << 28;

    /// Returns the number of proxies by [group][layer][row][column], the last index running fastest; one
    /// layer where the window has none. Valid until the next call. Not from within `groupOf` (asserted).
    /// Cost: the grid's cells in the window, at most one test for each proxy (Grid::visit()), and the counts
    /// set to 0.
    std::span<const std::uint32_t> scan(const Grid<Scalar>& grid, const RadarWindow<Scalar>& window,
                                        std::uint32_t groupCount, RadarGroups groupOf) &;

    /// What the last scan() cost; hits are boxes that touch the window's bounds.
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
