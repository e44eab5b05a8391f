// SPDX-License-Identifier: Zlib
#pragma once

// Where a proxy is when it counts as a point. Agents measure from position to position; SphereRegion
// (regions.hpp) measures from a point to the box.
//
//     CollectCount neighbours;
//     grid.visit(PositionRegion<float>(positionOf(grid.box(agent)), 10), neighbours);  // itself included
//
// Units     metres
// Bad data  A box with a NaN, an inverted or an infinite box has no position: no ball finds it.
// Threads   values and pure functions; use them from any thread

#include <broadphase/aabb.hpp>
#include <broadphase/geometry/unit_scale.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Returns the position of a box: its centre [m], which lies in the closed box and does not overflow. NaN on
/// all axes for a box without a position: with a NaN, inverted, or infinite on any side. Cost: O(1).
template <class Scalar>
[[nodiscard]] Vector3<Scalar> positionOf(const Aabb<Scalar>& box) noexcept {
    Vector3<Scalar> position;
    bool isSomewhere = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Scalar low = box.min()[axis];
        const Scalar high = box.max()[axis];
        const Scalar middle = low / 2 + high / 2;
        isSomewhere &= (low <= high) & detail::isFinite(middle);
        // Half of the smallest numbers is rounded, and might leave the box.
        position[axis] = std::min(std::max(middle, low), high);
    }
    if (!isSomewhere) {
        position.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    }
    return position;
}

/// Every proxy whose position is within `radius` [m] of `center` (closed ball). Key: squared distance [m^2]
/// between position and centre, which may round to 0 or infinity. A proxy without a position is in no ball. A
/// proxy so far away that the distance overflows is only in a ball with an infinite radius. A negative
/// radius, a NaN, or a centre that is not finite makes the region empty.
template <class Scalar>
class PositionRegion {
public:
    /// The ball around `center` [m].
    PositionRegion(const Vector3<Scalar>& center, Scalar radius)
        : center_(center), radius_(radius), scale_(detail::unitScale(radius)) {
        if (!detail::areFinite(center)) {
            radius_ = std::numeric_limits<Scalar>::quiet_NaN();
        }
    }

    /// The squared distance [m^2] to the position of the box, or -1 outside of the ball.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        return keyAt(positionOf(box));
    }

    /// The key of a box with this position [m]; -1 for a NaN.
    [[nodiscard]] Scalar keyAt(const Vector3<Scalar>& position) const noexcept {
        return detail::squareWithin(position[0] - center_[0], position[1] - center_[1],
                                    position[2] - center_[2], radius_, scale_);
    }

    /// The cube around the ball, rounded outward; NaN when the region is empty.
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept {
        using Limits = std::numeric_limits<Scalar>;
        if (detail::isNan(radius_) || !(radius_ >= 0)) {
            const auto nan = Vector3<Scalar>::Constant(Limits::quiet_NaN());
            return {nan, nan};
        }
        // Rounded outward, as keys are rounded. A box overlaps whatever its position lies in.
        const Scalar reach = center_.cwiseAbs().maxCoeff() + radius_;
        const Scalar padded = radius_ + 4 * Limits::epsilon() * reach + Limits::min();
        const auto half = Vector3<Scalar>::Constant(padded);
        return {center_ - half, center_ + half};
    }

    /// As given [m].
    [[nodiscard]] const Vector3<Scalar>& center() const noexcept { return center_; }
    /// As given [m], or NaN where the centre is not finite.
    [[nodiscard]] Scalar radius() const noexcept { return radius_; }

private:
    Vector3<Scalar> center_;
    Scalar radius_;
    Scalar scale_;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
