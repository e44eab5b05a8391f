// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move along a straight line during a frame, and the time when two of them first touch.
//
//     const MovingBox<float> bullet{box, velocity * seconds};
//     if (const std::optional<double> time = firstContact(bullet, {wall})) { ... }
//
// Time      from 0 (boxes as given) to 1 (moved by the whole displacement), both inclusive
// Closed    Touching a face, an edge or a corner for a moment counts.
// Exact     Whether boxes touch has no rounding error: always in single precision, from 1e-140 to 1e300 m in double.
//           The time is rounded to double precision.
// Units     metres
// Bad data  A box with a NaN, or with a NaN or infinite displacement, touches nothing.
// Threads   values and pure functions; use them from any thread
// Source    Ericson, "Real-Time Collision Detection", 5.5.8, with an exact comparison

#include <broadphase/aabb.hpp>
#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>
#include <broadphase/regions.hpp>

#include <cmath>
#include <optional>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A box that moves: at the time t it is `box` shifted by t * displacement. It stands still by default.
template <class Scalar>
struct MovingBox {
    Aabb<Scalar> box;                                        ///< at time 0 [m]
    Vector3<Scalar> displacement = Vector3<Scalar>::Zero();  ///< from time 0 to 1 [m]
};

/// Returns a box [m] around the moving box between the times `from` and `to`. Rounded outward: a little too large,
/// never too small. Cost: O(1).
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT Aabb<Scalar> sweptBounds(const MovingBox<Scalar>& moving,
                                                                   double from = 0, double to = 1);

template <class Scalar>
[[deprecated("sweptBounds()")]] [[nodiscard]] Aabb<Scalar> wayBounds(
    const MovingBox<Scalar>& moving, double from = 0, double to = 1) {
    return sweptBounds(moving, from, to);
}

namespace detail {

/// firstContact(), slower, and correct if rounding would decide.
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::optional<double> firstContactExactly(
    const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) noexcept;

/// Computed times have a relative error below this.
inline constexpr double kTimeDoubt = 0x1p-49;
/// Below this, a relative error means nothing.
inline constexpr double kTiniest = 0x1p-1000;

}  // namespace detail

/// Returns the first time at which the two boxes touch: 0 if they touch from the start, nothing if they never touch
/// in the frame. Cost: some ten nanoseconds; half a microsecond if rounding would decide.
template <class Scalar>
[[nodiscard]] inline std::optional<double> firstContact(const MovingBox<Scalar>& a,
                                                        const MovingBox<Scalar>& b) noexcept {
    // Slabs. Differences and their quotients have the right sign, and one rounding each.
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
    // No NaN and no infinity, not in inverses either.
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

/// Every box that a moving box meets on its way; the boxes of the grid stand still. Key: the time of the first
/// contact, by firstContact(). CollectClosest finds the box that is hit first:
///
///     CollectClosest<float> hit;
///     grid.visit(MovingBoxRegion<float>({box, displacement}), hit);  // at the time hit.key()
///
/// A moving proxy of the grid finds itself too: exclude it by CollectIf.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT MovingBoxRegion {
public:
    /// Cost: O(1).
    explicit MovingBoxRegion(const MovingBox<Scalar>& moving);

    /// Returns the time of the first contact, rounded to Scalar; -1 without a contact.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& other) const noexcept {
        const std::optional<double> time = firstContact(moving_, MovingBox<Scalar>{other});
        return time ? static_cast<Scalar>(*time) : Scalar(-1);
    }

    /// The way as a ray, a little thicker than the box because of rounding.
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
