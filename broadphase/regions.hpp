// SPDX-License-Identifier: Zlib
#pragma once

// Regions define where a query searches. A region has two members:
//
//   key(box)   returns a distance of 0 or more that the region defines; negative if the box is outside
//   bounds()   returns a box that overlaps every box in the region
//
//     CollectClosest<float> closest;
//     grid.visit(SphereRegion<float>(center, 10), closest);  // the box nearest to `center`, within 10 m
//
// key() decides the result. bounds() only saves work: the box may be too large, but never too small. If the class has
// a constant kIsItsBounds, of any value, queries may skip key(): every box that overlaps bounds() must have key 0. A
// region along a line has segment() instead of bounds(). segment() returns a RayRegion, whose key must be at most the
// region's key for every box in the region. ConvexRegion has an internal volume() instead of bounds(). Do not give
// your regions a volume().
//
// Others   PositionRegion (positions, not boxes), CellsRegion (estimates the proxies in a ball), MovingBoxRegion
//          (first contact of a moving box), ConvexRegion (frusta), and any class of yours that has key(), and
//          bounds() or segment()
// Units    metres; keys differ: m^2 in SphereRegion, a fraction from 0 to 1 in RayRegion
// NaN      A region with a NaN is empty: queries find no box.
// Threads  values; use them from any thread

#include <broadphase/aabb.hpp>
#include <broadphase/geometry/unit_scale.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Every box that overlaps the closed `box`. overlaps() decides this, also for infinite and inverted boxes. All keys
/// are 0.
template <class Scalar>
struct BoxRegion {
    static constexpr bool kIsItsBounds = true;

    Aabb<Scalar> box;  ///< [m]

    [[nodiscard]] Scalar key(const Aabb<Scalar>& other) const noexcept {
        return overlaps(box, other) ? Scalar(0) : Scalar(-1);
    }

    [[nodiscard]] const Aabb<Scalar>& bounds() const noexcept { return box; }
};

/// Every box within `radius` [m] of `center` (closed ball). The key is the squared distance [m^2] from the centre to
/// the box, 0 if the centre is inside the box. If the radius is negative, the region is empty. If the radius is
/// infinite, the region contains every box.
template <class Scalar>
class SphereRegion {
public:
    /// The ball around `center` [m].
    SphereRegion(const Vector3<Scalar>& center, Scalar radius)
        : center_(center), radius_(radius), scale_(detail::unitScale(radius)) {}

    /// Returns the squared distance [m^2]; -1 if the box is outside the ball. The square may round to 0 or infinity.
    /// This does not affect whether the box is in the ball.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        Scalar outside[3] = {};
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar before = box.min()[axis] - center_[axis];
            const Scalar behind = center_[axis] - box.max()[axis];
            if (detail::isNan(before) || detail::isNan(behind)) {
                return -1;
            }
            outside[axis] = std::max({before, behind, Scalar(0)});
        }
        return detail::squareWithin(outside[0], outside[1], outside[2], radius_, scale_);
    }

    /// The cube around the ball, rounded outward. All coordinates are NaN when the region is empty.
    [[nodiscard]] Aabb<Scalar> bounds() const noexcept {
        using Limits = std::numeric_limits<Scalar>;
        const bool isEmpty = detail::anyNan(center_) || detail::isNan(radius_) || !(radius_ >= 0);
        if (isEmpty || !detail::areFinite(center_)) {
            const auto all =
                Vector3<Scalar>::Constant(isEmpty ? Limits::quiet_NaN() : Limits::infinity());
            return {-all, all};
        }
        // Rounded outward: because key() rounds, it may accept a box slightly beyond the radius. The bounds must
        // touch that box too.
        const Scalar reach = center_.cwiseAbs().maxCoeff() + radius_;
        const Scalar padded = radius_ + 4 * Limits::epsilon() * reach + Limits::min();
        const Vector3<Scalar> half = Vector3<Scalar>::Constant(padded);
        return {center_ - half, center_ + half};
    }

private:
    Vector3<Scalar> center_;
    Scalar radius_;
    Scalar scale_;
};

/// Every box that a ray hits. The ray is a segment, or a box that moves along the segment (a "fat" ray). The key
/// is the fraction of the segment at which the ray enters the box, 0 if the start of the ray touches the box.
///
/// Touching a face, an edge or a corner is a hit. If rounding leaves doubt, the ray hits. The length may be 0. If an
/// end or the length is infinite, or any number is NaN, the region is empty.
///
///     CollectClosest<float> first;
///     grid.visit(RayRegion<float>(from, to), first);  // entry: from + first.key() * (to - from)
template <class Scalar>
class RayRegion {
public:
    /// The segment from `from` to `to` [m]. `fatness` [m] is the moving box relative to the moving point, for example
    /// (-halfExtents, halfExtents). By default, the ray is a line without thickness.
    RayRegion(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
              const Aabb<Scalar>& fatness = {Vector3<Scalar>::Zero(), Vector3<Scalar>::Zero()})
        : from_(from), direction_(to - from), fatness_(fatness) {
        using Limits = std::numeric_limits<Scalar>;
        if (!detail::areFinite(from_) || !detail::areFinite(direction_) || hasNan(fatness_)) {
            direction_.setConstant(Limits::quiet_NaN());
        } else if (direction_.cwiseAbs().maxCoeff() > 1 / Limits::min()) {
            scale_ = Scalar(0.125);
        }
        // key() rounds, so the fatness grows by the rounding error.
        const auto rounding = [](const Vector3<Scalar>& corner) {
            return (Limits::epsilon() * corner.cwiseAbs().cwiseMin(Limits::max())).eval();
        };
        fatness_.min() -= rounding(fatness_.min());
        fatness_.max() += rounding(fatness_.max());
        last_ = fatness.min().isZero(0) && fatness.max().isZero(0) ? Scalar(1) : kWidened;
        inverse_ = (scale_ * direction_).cwiseInverse();
        for (int axis = 0; axis < 3; ++axis) {
            if (!detail::isFinite(inverse_[axis]) && !detail::isNan(inverse_[axis])) {
                // If a component has no finite inverse, the box grows by that component instead.
                (direction_[axis] > 0 ? fatness_.max() : fatness_.min())[axis] += direction_[axis];
                direction_[axis] = 0;
            }
        }
    }

    /// Returns the fraction from 0 to 1 at which the ray enters the box; -1 if the ray misses.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept {
        if (HASHPHASE_OVERLOOKS_NAN && isEmpty()) {
            return -1;
        }
        // Slab method; the error of each distance is at most gamma(3), see Pharr, Jakob, Humphreys,
        // "Physically Based Rendering", 4th edition, section 6.8.3.
        Scalar enter = 0;
        Scalar exit = last_;
        for (int axis = 0; axis < 3; ++axis) {
            // Subtract `from_` first: small numbers stay exact far from the origin.
            const Scalar relativeMin = box.min()[axis] - from_[axis];
            const Scalar relativeMax = box.max()[axis] - from_[axis];
            if (direction_[axis] == 0) {
                // Compare without a difference: both numbers may be infinite.
                if (!(relativeMin <= fatness_.max()[axis] && relativeMax >= fatness_.min()[axis])) {
                    return -1;
                }
                continue;
            }
            const Scalar low = relativeMin - fatness_.max()[axis];
            const Scalar high = relativeMax - fatness_.min()[axis];
            Scalar slabEnter = low * scale_ * inverse_[axis];
            Scalar slabExit = high * scale_ * inverse_[axis];
            if (direction_[axis] < 0) {
                std::swap(slabEnter, slabExit);
            }
            if (!(slabEnter <= slabExit)) {
                return -1;
            }
            slabExit *= slabExit > 0 ? kWidened : Scalar(1);
            enter = std::max(enter, slabEnter);
            exit = std::min(exit, slabExit);
        }
        return enter <= exit ? std::min(enter, Scalar(1)) : Scalar(-1);
    }

    /// True if an end or the length of the segment is NaN or infinite, or `fatness` has a NaN: the region is empty.
    [[nodiscard]] bool isEmpty() const noexcept { return detail::anyNan(direction_); }
    /// The start of the ray [m].
    [[nodiscard]] const Vector3<Scalar>& from() const noexcept { return from_; }
    /// `to` - `from` [m]; components without a finite inverse are 0. NaN when isEmpty().
    [[nodiscard]] const Vector3<Scalar>& direction() const noexcept { return direction_; }
    /// The `fatness` given to the constructor [m], thicker by at most a rounding error.
    [[nodiscard]] const Aabb<Scalar>& fatness() const noexcept { return fatness_; }

    /// Returns this ray. If a region has segment(), grids search along that ray, in cells or in a tree of boxes.
    [[nodiscard]] const RayRegion& segment() const noexcept { return *this; }

private:
    // Covers rounding errors.
    static constexpr Scalar kWidened = 1 + 6 * std::numeric_limits<Scalar>::epsilon();

    Vector3<Scalar> from_;
    Vector3<Scalar> direction_;
    Vector3<Scalar> inverse_;  // inverse of scale_ * direction_
    Aabb<Scalar> fatness_;
    Scalar last_ = 1;  // largest key before clamping to 1; above 1 for fat rays
    // A power of two: below 1 if the inverse would be denormal.
    Scalar scale_ = 1;
};

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
