// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/aabb.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>
#include <cmath>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Finds every proxy whose box touches a cell that a ball's bounding box touches. This approximates the proxies in
/// the ball, without computing distances. The key of every proxy is 0.
///
///     CollectCount count;
///     grid.visit(CellsRegion<float>(center, 20, grid.cellSize()), count);
///
/// The result includes all proxies that a PositionRegion or SphereRegion of the ball finds. Apart from rounding,
/// every other box found has a point at most radius + cellSize from the centre on each axis: at most
/// sqrt(3) * (radius + cellSize) away.
///
/// Source: Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing", 2005,
/// "AI proximity decisions". (Unlike this class, the paper's loop omits the last cells.)
template <class Scalar>
class CellsRegion {
public:
    /// The ball has `center` and `radius` [m]. Cells are cubes with corners at multiples of `cellSize` [m]. If
    /// `cellSize` is 0 or less, NaN or infinite, the region is the ball's bounding box. If the radius is negative or
    /// NaN, or the centre is not finite, the region is empty.
    CellsRegion(const Vector3<Scalar>& center, Scalar radius, Scalar cellSize)
        : bounds_(PositionRegion<Scalar>(center, radius).bounds()) {
        const bool hasCells = cellSize > 0 && detail::isFinite(cellSize);
        for (int axis = 0; hasCells && axis < 3; ++axis) {
            Scalar& low = bounds_.min()[axis];
            Scalar& high = bounds_.max()[axis];
            const Scalar lowBorder = std::floor(low / cellSize) * cellSize;
            const Scalar highBorder = (std::floor(high / cellSize) + 1) * cellSize;
            // Borders only enlarge the box. A NaN border changes nothing.
            low = lowBorder < low ? lowBorder : low;
            high = highBorder > high ? highBorder : high;
        }
    }

    /// Returns 0 if the box overlaps bounds(), else -1.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        return overlaps(bounds_, box) ? Scalar(0) : Scalar(-1);
    }
    /// Returns the box around all cells of the region [m]; a NaN box if the region is empty.
    [[nodiscard]] const Aabb<Scalar>& bounds() const noexcept { return bounds_; }

private:
    Aabb<Scalar> bounds_;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
