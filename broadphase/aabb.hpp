// SPDX-License-Identifier: Zlib
#pragma once

// Axis-aligned bounding boxes, and overlaps(), which tests if two boxes overlap.
//
//     const Aabb<float> crate = boxAround<float>({0, 1, 0}, {0.5F, 1, 0.5F});
//     if (overlaps(crate, boxBetween<float>({0, 0, 0}, {4, 2.5F, 1}))) { ... }
//
// Units    metres, or any other unit of length; use one unit everywhere
// Closed   Boxes contain their faces, as in Bullet: touching boxes overlap.
// NaN      A box with a NaN coordinate overlaps nothing.
// Cost     O(1), no allocation
// Threads  values and pure functions; use them from any thread

#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>

#include <Eigen/Geometry>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A point or a displacement: x, y, z [m].
template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

/// A box from min() to max(), both inclusive. It may be infinite, or inverted (min > max) like Aabb<Scalar>().
/// overlaps() defines which boxes such boxes overlap.
template <class Scalar>
using Aabb = Eigen::AlignedBox<Scalar, 3>;

/// Returns the box from `min` to `max` [m], for example boxBetween<float>({0, 0, 0}, {4, 2.5F, 1}). If min > max on
/// an axis, the box is inverted.
template <class Scalar>
[[nodiscard]] inline Aabb<Scalar> boxBetween(const Vector3<Scalar>& min,
                                             const Vector3<std::type_identity_t<Scalar>>& max) {
    return {min, max};
}

/// Returns the box from `center` - `halfExtents` to `center` + `halfExtents` [m]. Coordinates may have rounding
/// errors. Negative half extents make an inverted box.
template <class Scalar>
[[nodiscard]] inline Aabb<Scalar> boxAround(
    const Vector3<Scalar>& center, const Vector3<std::type_identity_t<Scalar>>& halfExtents) {
    return {center - halfExtents, center + halfExtents};
}

/// Returns the cube around a ball. `radius` [m] is the half extent on every axis.
template <class Scalar>
[[nodiscard]] inline Aabb<Scalar> boxAround(const Vector3<Scalar>& center,
                                            std::type_identity_t<Scalar> radius) {
    return boxAround<Scalar>(center, Vector3<Scalar>::Constant(radius));
}

/// True when any of the six coordinates is NaN.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool hasNan(const Aabb<Scalar>& box) noexcept {
    const Scalar* low = box.min().data();
    const Scalar* high = box.max().data();
    return detail::areUnordered(low[0], high[0]) || detail::areUnordered(low[1], high[1]) ||
           detail::areUnordered(low[2], high[2]);
}

/// True when a.min <= b.max and b.min <= a.max on every axis. If neither box is inverted, this means that the closed
/// boxes share a point. False when any of the twelve coordinates is NaN.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool overlaps(const Aabb<Scalar>& a,
                                                            const Aabb<Scalar>& b) noexcept {
    if (HASHPHASE_OVERLOOKS_NAN && (hasNan(a) || hasNan(b))) {
        return false;
    }
    const Scalar* aMin = a.min().data();
    const Scalar* aMax = a.max().data();
    const Scalar* bMin = b.min().data();
    const Scalar* bMax = b.max().data();
    return ((aMin[0] <= bMax[0]) & (bMin[0] <= aMax[0]) & (aMin[1] <= bMax[1]) &
            (bMin[1] <= aMax[1]) & (aMin[2] <= bMax[2]) & (bMin[2] <= aMax[2])) != 0;
}

/// True when a and b have the same bits: -0 differs from 0, and a NaN equals itself.
template <std::floating_point Scalar>
[[nodiscard]] inline bool isSameBits(Scalar a, Scalar b) noexcept {
    using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

/// True when each coordinate of a has the same bits as in b. The code compares one number at a time, because a SIMD
/// read of numbers just written would stall.
template <class Scalar>
[[nodiscard]] inline bool isSameBits(const Aabb<Scalar>& a, const Aabb<Scalar>& b) noexcept {
    const Scalar* aMin = a.min().data();
    const Scalar* aMax = a.max().data();
    const Scalar* bMin = b.min().data();
    const Scalar* bMax = b.max().data();
    return isSameBits(aMin[0], bMin[0]) && isSameBits(aMin[1], bMin[1]) &&
           isSameBits(aMin[2], bMin[2]) && isSameBits(aMax[0], bMax[0]) &&
           isSameBits(aMax[1], bMax[1]) && isSameBits(aMax[2], bMax[2]);
}

namespace detail {

/// Like Eigen's allFinite() and hasNaN(), but these functions are also correct with -ffast-math.
template <class Scalar>
[[nodiscard]] inline bool areFinite(const Vector3<Scalar>& point) noexcept {
    return isFinite(point[0]) && isFinite(point[1]) && isFinite(point[2]);
}
template <class Scalar>
[[nodiscard]] inline bool anyNan(const Vector3<Scalar>& point) noexcept {
    return isNan(point[0]) || isNan(point[1]) || isNan(point[2]);
}

}  // namespace detail

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
