// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move along a straight line during a frame, and the time when two such boxes first touch.
//
//     const MovingBox<float> bullet{box, velocity * seconds};
//     if (const std::optional<double> time = firstContact(bullet, {wall})) { ... }
//
// Time      from 0 (boxes as given) to 1 (moved by the whole displacement), both inclusive
// Closed    Sharing a face, an edge or a corner for a moment counts as touching.
// Exact     The decision whether boxes touch has no rounding error: always in single precision; in double precision
//           if all coordinates and displacements other than 0 are from 1e-140 to 1e300 m in magnitude, and none is
//           more than 1e140 times another. The time is rounded to double precision.
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

/// A moving box: at time t, it is `box` shifted by t * displacement. By default, the displacement is 0.
template <class Scalar>
struct MovingBox {
    Aabb<Scalar> box;                                        ///< the box at time 0 [m]
    Vector3<Scalar> displacement = Vector3<Scalar>::Zero();  ///< the shift from time 0 to 1 [m]
};

/// Returns a box [m] around the moving box from time `from` to time `to`, rounded outward: a little too large, never
/// too small. Cost: O(1).
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT Aabb<Scalar> sweptBounds(const MovingBox<Scalar>& moving,
                                                                   double from = 0, double to = 1);

template <class Scalar>
[[deprecated("sweptBounds()")]] [[nodiscard]] Aabb<Scalar> wayBounds(
    const MovingBox<Scalar>& moving, double from = 0, double to = 1) {
    return sweptBounds(moving, from, to);
}

namespace detail {

/// The slower part of firstContact(). It is exact even if rounding could change the result.
template <class Scalar>
[[nodiscard]] HASHPHASE_BROADPHASE_EXPORT std::optional<double> firstContactExactly(
    const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) noexcept;

/// Upper bound of the relative error of computed times.
inline constexpr double kTimeDoubt = 0x1p-49;
/// If a number is smaller than this in magnitude, products may underflow, and errors may exceed kTimeDoubt.
inline constexpr double kTiniest = 0x1p-1000;

}  // namespace detail

/// Returns the first time at which the two boxes touch: 0 if they touch at the start, std::nullopt if they do not
/// touch in the frame. Cost: about ten nanoseconds, or half a microsecond if rounding could change the result.
template <class Scalar>
[[nodiscard]] inline std::optional<double> firstContact(const MovingBox<Scalar>& a,
                                                        const MovingBox<Scalar>& b) noexcept {
    // Slab method. Each difference, inverse and product rounds once, and has the right sign.
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
        const double ahead = closing > 0 ? below : above;   // the gap that closes
        const double behind = closing > 0 ? above : below;  // the gap that opens
        const double speed = std::abs(closing);
        sum += speed + std::abs(below) + std::abs(above);
        isTiny |= (speed > 0) & (speed < detail::kTiniest);
        neverMeet |= (behind > 0) | ((ahead > 0) & (speed == 0));
        const double inverse = 1 / (speed > 0 ? speed : 1);
        const double opens = speed > 0 ? -behind * inverse : 1;
        begin = ahead * inverse > begin ? ahead * inverse : begin;
        end = opens < end ? opens : end;
    }
    // True when all numbers and all inverses are finite.
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

/// Finds every box that a moving box touches along its path. The boxes of the grid count as not moving. The key is
/// the time that firstContact() returns. CollectClosest finds the box that is hit first:
///
///     CollectClosest<float> hit;
///     grid.visit(MovingBoxRegion<float>({box, displacement}), hit);  // touches at time hit.key()
///
/// If the moving box is a proxy of the grid, the query finds this proxy too. Exclude it with CollectIf.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT MovingBoxRegion {
public:
    /// The region of boxes that `moving` touches. Cost: O(1).
    explicit MovingBoxRegion(const MovingBox<Scalar>& moving);

    /// Returns the time of the first contact, rounded to Scalar; -1 if the boxes do not touch.
    [[nodiscard]] Scalar key(const Aabb<Scalar>& other) const noexcept {
        const std::optional<double> time = firstContact(moving_, MovingBox<Scalar>{other});
        return time ? static_cast<Scalar>(*time) : Scalar(-1);
    }

    /// The path as a fat ray, which is a little thicker than the box because of rounding.
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
