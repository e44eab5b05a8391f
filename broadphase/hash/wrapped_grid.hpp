// SPDX-License-Identifier: Zlib
#pragma once

// Cells of one size for points, wrapped around: what lies beyond the last cell of an axis goes on at
// its first one. Points that are far apart may share a cell, which costs a comparison of them and
// nothing else; in return, no point, however far away, makes the cells of the others many or large.
// Who looks around a cell meets every cell once, however the axes are wrapped.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::detail {

/// Coordinates of some of the points, by axis.
using PointSample = std::array<std::vector<double>, 3>;

struct WrappedGrid {
    // Halves, because differences of large numbers would overflow.
    std::array<double, 3> halfOrigin{};
    double inverseHalfCellSize = 0;
    std::array<std::uint32_t, 3> extent{1, 1, 1};  // cells
    std::uint32_t reach = 1;  // points within the radius are so many cells apart

    [[nodiscard]] std::uint32_t cellCount() const noexcept {
        return extent[0] * extent[1] * extent[2];
    }

    /// The cell of a coordinate along the axis. In double precision, because no rounding may take
    /// points that are within the radius further apart than `reach`: it is monotone, and less than
    /// what the cells are larger than they need be.
    [[nodiscard]] std::uint32_t cellAlong(std::size_t axis, double x) const noexcept {
        if (extent[axis] == 1) {
            return 0;
        }
        constexpr double kLimit = 1 << 30;
        double scaled = (x / 2 - halfOrigin[axis]) * inverseHalfCellSize;
        scaled = scaled < kLimit ? scaled : kLimit;
        scaled = scaled > -kLimit ? scaled : -kLimit;
        const auto truncated = static_cast<std::int32_t>(scaled);
        const std::int32_t cell =
            truncated - static_cast<std::int32_t>(static_cast<double>(truncated) > scaled);
        return static_cast<std::uint32_t>(cell) < extent[axis] ? static_cast<std::uint32_t>(cell)
                                                               : wrapped(cell, extent[axis]);
    }

    /// The number of the cell of a point; those of a row along x follow one another.
    [[nodiscard]] std::uint32_t cellOf(double x, double y, double z) const noexcept {
        return (cellAlong(2, z) * extent[1] + cellAlong(1, y)) * extent[0] + cellAlong(0, x);
    }

private:
    [[nodiscard]] static std::uint32_t wrapped(std::int32_t cell, std::uint32_t extent) noexcept {
        const auto size = static_cast<std::int32_t>(extent);
        const std::int32_t rest = cell % size;
        return static_cast<std::uint32_t>(rest < 0 ? rest + size : rest);
    }
};

/// Cells for `count` points, of which the sample tells where they are (its order changes), and for
/// searches within `radius`, which is not negative and may be infinite. Cost: that of the sample.
[[nodiscard]] WrappedGrid wrappedGridFor(PointSample& sample, double radius, std::size_t count);

}  // namespace hashphase::detail
