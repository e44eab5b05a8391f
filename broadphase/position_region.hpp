// SPDX-License-Identifier: Zlib
#pragma once

// Treats each proxy as a point, its position, and finds the positions in a ball. SphereRegion (regions.hpp) measures
// the distance to the box instead.
//
//     CollectCount neighbours;
//     grid.visit(PositionRegion<float>(positionOf(grid.box(agent)), 10), neighbours);  // includes the agent
//
// Units     metres
// Bad data  A box that is inverted, or has a NaN or infinite face, has no position: no ball finds it.
// Threads   values and pure functions; use them from any thread

#include <broadphase/aabb.hpp>
#include <broadphase/geometry/unit_scale.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Returns the centre of the box [m], which rounding never moves out of the closed box. Large coordinates do not
/// overflow. NaN if the box has no position. Cost: O(1).
template <class Scalar>
[[nodiscard]] Vector3<Scalar> positionOf(const Aabb<Scalar>& box) noexcept {
    Vector3<Scalar> position;
    bool isSomewhere = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Scalar low = box.min()[axis];
        const Scalar high = box.max()[axis];
        const Scalar middle = low / 2 + high / 2;
        isSomewhere &= (low <= high) & detail::isFinite(middle);
        // Half of a denormal rounds, perhaps out of the box.
        position[axis] = std::min(std::max(middle, low), high);
    }
    if (!isSomewhere) {
        position.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    }
    return position;
}

/// Every proxy whose position is within `radius` [m] of `center` (closed ball). The key is the squared distance
/// [m^2] from the centre. The square may round to 0 or infinity. If the distance itself overflows, only an infinite
/// radius finds the proxy. The region is empty if the radius is negative or NaN, or the centre is not finite.
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

    /// Returns the squared distance [m^2] to the box's position; -1 if the position is outside the ball.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        return keyAt(positionOf(box));
    }

    /// Returns key() of a box with this position [m]; -1 if a coordinate is NaN.
    [[nodiscard]] Scalar keyAt(const Vector3<Scalar>& position) const noexcept {
        return detail::squareWithin(position[0] - center_[0], position[1] - center_[1],
                                    position[2] - center_[2], radius_, scale_);
    }

    /// The cube around the ball, rounded outward. All coordinates are NaN when the region is empty.
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept {
        using Limits = std::numeric_limits<Scalar>;
        if (detail::isNan(radius_) || !(radius_ >= 0)) {
            const auto nan = Vector3<Scalar>::Constant(Limits::quiet_NaN());
            return {nan, nan};
        }
        // Rounded outward, because key() rounds. If the cube contains the position of a box, the box overlaps the
        // cube.
        const Scalar reach = center_.cwiseAbs().maxCoeff() + radius_;
        const Scalar padded = radius_ + 4 * Limits::epsilon() * reach + Limits::min();
        const auto half = Vector3<Scalar>::Constant(padded);
        return {center_ - half, center_ + half};
    }

    /// The centre as given [m].
    [[nodiscard]] const Vector3<Scalar>& center() const noexcept { return center_; }
    /// The radius as given [m]; NaN if the centre is not finite.
    [[nodiscard]] Scalar radius() const noexcept { return radius_; }

private:
    Vector3<Scalar> center_;
    Scalar radius_;
    Scalar scale_;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
