// SPDX-License-Identifier: Zlib
#pragma once

// A radar: counts of proxies in coarse cells, by group (paper, "condensed view of a section of the domain").
//
// Counted   Each proxy in the window counts once, in the cell of its position (position_region.hpp). A position on a
//           border belongs to the cell with larger coordinates.
// Threads   scan() is a query of the grid. No other thread may use this object meanwhile.
// Bad data  All counts are 0 if the cell size is not positive and finite, or the centre or heading is not finite.
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

/// The window of a radar. Columns follow the first axis that is not up, rows the second: x and z if y is up.
template <class Scalar>
struct RadarWindow {
    Vector3<Scalar> center = Vector3<Scalar>::Zero();  ///< [m]
    Scalar cellSize = 10;                              ///< edge of the coarse cells [m]
    std::uint32_t columns = 32;
    std::uint32_t rows = 32;
    std::uint32_t layers = 0;  ///< number of layers upwards; 0: one layer for all heights
    UpAxis up = UpAxis::y;

    /// Without a heading, cells begin at multiples of the cell size. So counts of resting proxies do not flicker
    /// while the centre moves within its cell, or if the origin shifts by such a multiple. The window begins
    /// columns / 2 cells (rounded down) before the cell of the centre; likewise rows and layers.
    ///
    /// A heading [rad] turns the window about the up axis. With a heading, the centre is in the window's middle:
    /// between two columns if the number of columns is even. Row indices grow along (sin, cos) of the heading in
    /// (column axis, row axis), column indices along (cos, -sin).
    std::optional<Scalar> heading = std::nullopt;
};

/// Returns the group of a proxy. The proxy counts only if its group is less than the number of groups.
using RadarGroups = FunctionRef<std::uint32_t(ProxyId)>;

/// Counts proxies by cell and group. Reuses its memory: a frame that needs no more than before allocates nothing.
template <class Scalar>
class HASHPHASE_AI_TEMPLATE_EXPORT Radar {
public:
    static constexpr std::size_t kMostCounts = std::size_t{1} << 28;

    /// Counts the proxies in the window. Returns counts in the order [group][layer][row][column], columns fastest. If
    /// `layers` is 0, there is one layer. The span is valid until the next scan(). Asserted: `groupOf` does not call
    /// scan(). Cost: one Grid::visit() of the window, and clearing the counts.
    std::span<const std::uint32_t> scan(const Grid<Scalar>& grid, const RadarWindow<Scalar>& window,
                                        std::uint32_t groupCount, RadarGroups groupOf) &;

    /// Cost of the last scan(). Its hits are boxes that touch the window's bounds.
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
