// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/aabb.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>
#include <cmath>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Every proxy whose box touches a cell that a ball's box touches: an estimate of who is in the ball
/// for which no distance is computed (paper, "AI proximity decisions"; its loop over the cells left
/// out the last of them, and where the ball was smaller than a cell, all). Key: 0.
///
/// Finds everybody that PositionRegion(center, radius) and SphereRegion(center, radius) find, and
/// beyond them only boxes that come nearer than radius + cellSize on each axis, but for rounding:
/// nobody whose box is farther away than sqrt(3) * (radius + cellSize). Cells are cubes with corners
/// at the multiples of `cellSize` [m]; with one that is 0 or less, NaN or infinite, the ball's box is
/// taken as it is. Empty when the ball is.
template <class Scalar>
class CellsRegion {
public:
    CellsRegion(const Vector3<Scalar>& center, Scalar radius, Scalar cellSize)
        : bounds_(PositionRegion<Scalar>(center, radius).bounds()) {
        const bool hasCells = cellSize > 0 && std::isfinite(cellSize);
        for (int axis = 0; hasCells && axis < 3; ++axis) {
            Scalar& low = bounds_.min()[axis];
            Scalar& high = bounds_.max()[axis];
            const Scalar lowBorder = std::floor(low / cellSize) * cellSize;
            const Scalar highBorder = (std::floor(high / cellSize) + 1) * cellSize;
            // Rounded outward; a NaN comes of numbers that are far too large for such cells.
            low = lowBorder < low ? lowBorder : low;
            high = highBorder > high ? highBorder : high;
        }
    }

    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        return overlaps(bounds_, box) ? Scalar(0) : Scalar(-1);
    }
    [[nodiscard]] const Aabb<Scalar>& bounds() const noexcept { return bounds_; }

private:
    Aabb<Scalar> bounds_;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
