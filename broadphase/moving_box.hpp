// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move along a straight line during a frame, and when two of them first touch.
//
//     const MovingBox<float> bullet{box, velocity * seconds};
//     if (const std::optional<double> time = firstContact(bullet, {wall})) { ... }
//
// Time      runs from 0, where the boxes are as given, to 1, where each has moved by its whole
//           displacement. Both ends count.
// Closed    Boxes that touch for a moment only, at a face, an edge or a corner, do touch.
// Exact     Whether two boxes touch is decided without a rounding error: always in single precision, in
//           double precision between 1e-140 and 1e300 m. The time is rounded to double precision.
// Units     metres; times are fractions of the frame
// Bad data  A box with a NaN touches nothing, nor does one with a NaN or infinite displacement.
// Threads   values and pure functions; use them from any thread
//
// After Ericson, "Real-Time Collision Detection", 5.5.8, with the comparison made exact.

#include <broadphase/aabb.hpp>
#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>
#include <broadphase/regions.hpp>

#include <cmath>
#include <optional>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A box that moves: at the time t it is `box` shifted by t * displacement. By default it stands still.
template <class Scalar>
struct MovingBox {
    Aabb<Scalar> box;                                        ///< at the time 0 [m]
    Vector3<Scalar> displacement = Vector3<Scalar>::Zero();  ///< from the time 0 to 1 [m]
};

/// Returns a box around all places of the moving box between the times `from` and `to`, by default the whole
/// frame [m]. Rounded outward: it is a little larger than the exact one, never smaller. Cost: O(1).
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT Aabb<Scalar> sweptBounds(const MovingBox<Scalar>& moving,
                                                                   double from = 0, double to = 1);

template <class Scalar>
[[deprecated("sweptBounds()")]] [[nodiscard]] Aabb<Scalar> wayBounds(
    const MovingBox<Scalar>& moving, double from = 0, double to = 1) {
    return sweptBounds(moving, from, to);
}

namespace detail {

/// As firstContact(), slower, and right where rounding would decide.
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::optional<double> firstContactExactly(
    const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) noexcept;

/// A time as computed is off by less than this share of it.
inline constexpr double kTimeDoubt = 0x1p-49;
/// Below this, shares mean nothing.
inline constexpr double kTiniest = 0x1p-1000;

}  // namespace detail

/// Returns the first time at which the two boxes touch: 0 when they touch from the start, nothing when they
/// never touch in the frame. Cost: some ten nanoseconds; half a microsecond where rounding would decide.
template <class Scalar>
[[nodiscard]] inline std::optional<double> firstContact(const MovingBox<Scalar>& a,
                                                        const MovingBox<Scalar>& b) noexcept {
    // Slabs. Differences have the right sign, and one rounding; so do their quotients.
    double begin = 0;
    double end = 1;
    double sum = 0;
    bool isTiny = false;
    bool neverMeet = false;
    for (int axis = 0; axis < 3; ++axis) {
        const double closing =
            static_cast<double>(a.displacement[axis]) - static_cast<double>(b.displacement[axis]);
        const double below =
            static_cast<double>(b.box.min()[axis]) - static_cast<double>(a.box.max()[axis]);
        const double above =
            static_cast<double>(a.box.min()[axis]) - static_cast<double>(b.box.max()[axis]);
        const double ahead = closing > 0 ? below : above;   // closes, if anything
        const double behind = closing > 0 ? above : below;  // opens
        const double speed = std::abs(closing);
        sum += speed + std::abs(below) + std::abs(above);
        isTiny |= (speed > 0) & (speed < detail::kTiniest);
        neverMeet |= (behind > 0) | ((ahead > 0) & (speed == 0));
        const double inverse = 1 / (speed > 0 ? speed : 1);
        const double opens = speed > 0 ? -behind * inverse : 1;
        begin = ahead * inverse > begin ? ahead * inverse : begin;
        end = opens < end ? opens : end;
    }
    // No NaN, and nothing infinite, not even an inverse.
    const bool isUsual = detail::isFinite(sum) & !isTiny;
    if (isUsual && neverMeet) {
        return std::nullopt;
    }
    const bool isCertain =
        isUsual && (begin == 0 || begin > detail::kTiniest) &&
        (begin * (1 + detail::kTimeDoubt) < end || begin > end * (1 + detail::kTimeDoubt));
    if (!isCertain) {
        return detail::firstContactExactly(a, b);
    }
    return begin < end ? std::optional(begin) : std::nullopt;
}

/// Every box that a moving box meets on its way. Key: the time of the first contact, by firstContact(). The
/// boxes of the grid stand still. With CollectClosest a query finds the box that is hit first:
///
///     CollectClosest<float> hit;
///     grid.visit(MovingBoxRegion<float>({box, displacement}), hit);  // at the time hit.key()
///
/// Where the moving box is a proxy of the grid, the query finds that proxy too: leave it out by a CollectIf.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT MovingBoxRegion {
public:
    /// Cost: O(1).
    explicit MovingBoxRegion(const MovingBox<Scalar>& moving);

    /// The time of the first contact, rounded to Scalar, or -1 without a contact.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& other) const noexcept {
        const std::optional<double> time = firstContact(moving_, MovingBox<Scalar>{other});
        return time ? static_cast<Scalar>(*time) : Scalar(-1);
    }

    /// The way as a ray that is a little thicker than the box: the ray is rounded, key() is not.
    [[nodiscard]] const RayRegion<Scalar>& segment() const noexcept { return segment_; }

private:
    MovingBox<Scalar> moving_;
    RayRegion<Scalar> segment_;
};

extern template Aabb<float> sweptBounds(const MovingBox<float>&, double, double);
extern template Aabb<double> sweptBounds(const MovingBox<double>&, double, double);
extern template std::optional<double> detail::firstContactExactly(const MovingBox<float>&,
                                                                  const MovingBox<float>&) noexcept;
extern template std::optional<double> detail::firstContactExactly(
    const MovingBox<double>&, const MovingBox<double>&) noexcept;
extern template class MovingBoxRegion<float>;
extern template class MovingBoxRegion<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
