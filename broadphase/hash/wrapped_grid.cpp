// SPDX-License-Identifier: Zlib
#include <broadphase/hash/wrapped_grid.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace hashphase::detail {
namespace {

// So much larger than the radius are cells, for rounding.
constexpr double kSlack = 1 + 0x1p-10;

// Cells of half the radius let fewer points be compared in vain, but more runs of cells be read; they
// pay where so many points share one.
constexpr double kPointsInHalfCells = 12;

// One in so many points at either end of an axis may lie beyond the cells without being asked.
constexpr std::ptrdiff_t kStrays = 32;

struct Range {
    std::array<double, 3> low{};
    std::array<double, 3> half{};  // the extent, halved so that it does not overflow
};

// Of the sample, but for so many points at either end of an axis.
Range rangeOf(PointSample& sample, std::ptrdiff_t left) {
    Range range;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double>& column = sample[axis];
        const auto first = column.begin() + left;
        const auto last = column.end() - 1 - left;
        if (left > 0) {
            std::nth_element(column.begin(), first, column.end());
            std::nth_element(first, last, column.end());
        }
        const auto [low, high] = std::minmax_element(first, last + 1);
        range.low[axis] = *low;
        range.half[axis] = *high / 2 - *low / 2;
    }
    return range;
}

// In floating point, because there may be any number.
double cellsAlong(const Range& range, std::size_t axis, double cellSize) {
    return std::floor(2 * (range.half[axis] / cellSize)) + 1;
}

double cellsIn(const Range& range, double cellSize) {
    return cellsAlong(range, 0, cellSize) * cellsAlong(range, 1, cellSize) *
           cellsAlong(range, 2, cellSize);
}

}  // namespace

WrappedGrid wrappedGridFor(PointSample& sample, double radius, std::size_t count) {
    WrappedGrid wrapped;
    if (sample[0].empty()) {
        return wrapped;
    }
    const auto points = static_cast<double>(count);
    const double mostCells = std::min(4 * points + 64, 0x1p28);
    Range range = rangeOf(sample, 0);
    double cellSize = std::max(radius * kSlack, 0x1p-1000);
    // Where there are too many cells for so few points, strays may be what spreads them; else the
    // cells are too small.
    if (cellsIn(range, cellSize) > mostCells) {
        range = rangeOf(sample, std::ssize(sample[0]) / kStrays);
    }
    const double longest = *std::max_element(range.half.begin(), range.half.end());
    cellSize = std::max(cellSize, longest * 0x1p-28);  // which is not far from what fits
    while (cellsIn(range, cellSize) > mostCells) {
        cellSize *= 1.25;
    }
    if (points > kPointsInHalfCells * cellsIn(range, cellSize / 2)) {
        cellSize /= 2;
        wrapped.reach = 2;
    }
    wrapped.inverseHalfCellSize = 1 / (cellSize / 2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto cells = static_cast<std::uint32_t>(cellsAlong(range, axis, cellSize));
        // Cells that are all looked at together are one. Others have one behind them and one before
        // them, which is the last one, for points beyond the sample, and in between so many empty
        // ones that what is at one end does not meet what is at the other.
        const bool isOne = cells <= wrapped.reach + 1;
        wrapped.extent[axis] = isOne ? 1 : cells + 2 + wrapped.reach;
        wrapped.halfOrigin[axis] = range.low[axis] / 2;
    }
    return wrapped;
}

}  // namespace hashphase::detail
