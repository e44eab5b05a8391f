// SPDX-License-Identifier: Zlib
#pragma once

// A radar: counts of proxies in coarse cells, by group (paper, "condensed view of a section of the domain").
//
// Counted   Each proxy once, in the cell of its position (position_region.hpp), if that is in the window. A border
//           belongs to the cell above it.
// Threads   scan() reads the grid, as queries do, and needs this object for itself.
// Bad data  All counts are 0 with a cell size that is not positive and finite, or a centre or heading that is not
//           finite.
// Misuse    Asserted: at most kMostCounts counts.

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

/// The window of a radar. Columns lie along the first axis that is not up, rows along the second: x and z if y is up.
template <class Scalar>
struct RadarWindow {
    Vector3<Scalar> center = Vector3<Scalar>::Zero();  ///< [m]
    Scalar cellSize = 10;                              ///< edge of the coarse cells [m]
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t layers = 0;  ///< cells one above another; 0: one cell for all heights
    UpAxis up = UpAxis::y;

    /// Without a heading, cells begin at multiples of their size, so that counts of resting proxies do not flicker
    /// while the centre moves within its cell, or if the origin shifts by such a multiple. The window begins
    /// columns / 2 cells (rounded down) before the cell of the centre; likewise rows and layers.
    ///
    /// A heading [rad] turns the window about the up axis, with the centre in its middle: between two columns if
    /// their number is even. Rows grow along (sin, cos) of the heading in (column axis, row axis), columns along
    /// (cos, -sin).
    std::optional<Scalar> heading = std::nullopt;
};

/// Returns the group of a proxy. Proxies with a group not below the number of groups do not count.
using RadarGroups = FunctionRef<std::uint32_t(ProxyId)>;

/// Counts proxies by cell and group. Keeps its memory: a frame like the last one allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Radar {
public:
    static constexpr std::size_t kMostCounts = std::size_t{1} << 28;

    /// Counts the proxies in the window. Returns the counts as [group][layer][row][column], columns fastest, with one
    /// layer if `layers` is 0. Valid until the next call. Asserted: not called from `groupOf`. Cost: Grid::visit() of
    /// the window, and clearing the counts.
    std::span<const std::uint32_t> scan(const Grid<Scalar>& grid, const RadarWindow<Scalar>& window,
                                        std::uint32_t groupCount, RadarGroups groupOf) &;

    /// Cost of the last scan(). Hits are boxes that touch the window's bounds.
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
