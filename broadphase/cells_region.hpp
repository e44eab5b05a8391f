// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/aabb.hpp>
#include <broadphase/position_region.hpp>

#include <algorithm>
#include <cmath>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Every proxy whose box touches a cell that a ball's box touches: an estimate of the proxies in the ball, without
/// distances. Key: 0.
///
///     CollectCount count;
///     grid.visit(CellsRegion<float>(center, 20, grid.cellSize()), count);
///
/// Finds every proxy that PositionRegion and SphereRegion find. Other proxies are, within rounding, nearer than
/// radius + cellSize on each axis: at most sqrt(3) * (radius + cellSize) away.
///
/// Source: Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial Hashing", 2005,
/// "AI proximity decisions". (The loop there omits the last cells.)
template <class Scalar>
class CellsRegion {
public:
    /// The ball has `center` and `radius` [m]. Cells are cubes with corners at multiples of `cellSize` [m]. A cell
    /// size of 0 or less, NaN or infinity means the ball's box itself. The region is empty for a negative or NaN
    /// radius, or a centre that is not finite.
    CellsRegion(const Vector3<Scalar>& center, Scalar radius, Scalar cellSize)
        : bounds_(PositionRegion<Scalar>(center, radius).bounds()) {
        const bool hasCells = cellSize > 0 && detail::isFinite(cellSize);
        for (int axis = 0; hasCells && axis < 3; ++axis) {
            Scalar& low = bounds_.min()[axis];
            Scalar& high = bounds_.max()[axis];
            const Scalar lowBorder = std::floor(low / cellSize) * cellSize;
            const Scalar highBorder = (std::floor(high / cellSize) + 1) * cellSize;
            // Rounded outward; numbers far too large for such cells give a NaN.
            low = lowBorder < low ? lowBorder : low;
            high = highBorder > high ? highBorder : high;
        }
    }

    /// Returns 0 if the box overlaps bounds(), else -1.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        return overlaps(bounds_, box) ? Scalar(0) : Scalar(-1);
    }
    /// The box of all these cells [m]; NaN when the region is empty.
    [[nodiscard]] const Aabb<Scalar>& bounds() const noexcept { return bounds_; }

private:
    Aabb<Scalar> bounds_;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
