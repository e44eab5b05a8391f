// SPDX-License-Identifier: Zlib
#pragma once

// What a camera sees, as a convex region.
//
// Matrices  any view-projection matrix that maps world coordinates (columns: x, y, z, 1) to clip
//           coordinates: perspective or orthographic, oblique, with a reversed depth range or an infinite far
//           plane. The camera sees the points with -w <= x <= w, -w <= y <= w, and z by DepthRange.
//           A matrix of OpenGL, GLM or Vulkan, column by column from `const float* matrix`, is
//           Eigen::Map<const Eigen::Matrix4f>(matrix), as an argument of frustumRegion<float>().
// Units     metres in the world; normalised device coordinates from -1 to 1 on the screen.
// Bad data  A matrix that is NaN or infinite sees nothing; frustumError() says why. A singular matrix sees
//           what its planes enclose: a line of sight, a sheet, nothing. A transposed matrix is that of some
//           other camera; no check can find this.

#include <broadphase/aabb.hpp>
#include <broadphase/convex_region.hpp>
#include <broadphase/core/compiler.hpp>
#include <broadphase/core/unaligned.hpp>
#include <integration/camera/export.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// The depths of clip space: z from -w to w (minusOneToOne: OpenGL), or from 0 to w (zeroToOne: Direct3D,
/// Vulkan, Metal; also with a reversed depth range).
enum class DepthRange : std::uint8_t { minusOneToOne, zeroToOne };

/// Part of the screen in normalised device coordinates: x to the right, y upwards, from -1 to 1.
template <class Scalar>
using ScreenRectangle = Eigen::AlignedBox<Scalar, 2>;

/// Returns the rectangle from (-1, -1) to (1, 1).
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ScreenRectangle<Scalar> wholeScreen() {
    using Point = typename ScreenRectangle<Scalar>::VectorType;
    return {Point(-1, -1), Point(1, 1)};
}

namespace detail {

/// left, bottom, right, top
template <class Scalar>
using ScreenEdges = std::array<Scalar, 4>;

// What is handed to the libraries does not depend on how Eigen aligns a matrix and a rectangle of the
// program's (core/unaligned.hpp); these are therefore compiled with the program, wherever they are called.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ScreenEdges<Scalar> edgesOf(
    const ScreenRectangle<Scalar>& rectangle) {
    return {rectangle.min().x(), rectangle.min().y(), rectangle.max().x(), rectangle.max().y()};
}

template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string frustumError(
    const Matrix4<Scalar>& viewProjection, const ScreenEdges<Scalar>& edges);

template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::array<Plane<Scalar>, 6> frustumPlanes(
    const Matrix4<Scalar>& viewProjection, DepthRange depthRange, const ScreenEdges<Scalar>& edges);

}  // namespace detail

/// Says in a sentence why nothing can be seen through the matrix, 4 x 4, or through that part of the screen;
/// empty when something may be seen. It cannot tell a wrong matrix. To check yours, take a point that the
/// camera is known to see: `viewProjection * (x, y, z, 1)` has -w <= x <= w and -w <= y <= w.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::string frustumError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>()) {
    return detail::frustumError<Scalar>(viewProjection, detail::edgesOf<Scalar>(rectangle));
}

/// Returns the planes left, right, bottom, top, near and far of the view through the matrix, 4 x 4, in a
/// rectangle of the screen. All face inwards and are not normalised. With a reversed depth range near and far
/// change places; an infinite far plane has every point inside. After Gribb and Hartmann, "Fast Extraction of
/// Viewing Frustum Planes from the World-View-Projection Matrix" (2001).
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::array<Eigen::Hyperplane<Scalar, 3>, 6>
frustumPlanes(const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
              const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>()) {
    const auto planes = detail::frustumPlanes<Scalar>(viewProjection, depthRange,
                                                      detail::edgesOf<Scalar>(rectangle));
    using Plane = Eigen::Hyperplane<Scalar, 3>;
    return {Plane(planes[0]), Plane(planes[1]), Plane(planes[2]),
            Plane(planes[3]), Plane(planes[4]), Plane(planes[5])};
}

/// Returns the view as a region: frustumPlanes() as a ConvexRegion. Cost: some microseconds.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ConvexRegion<Scalar> frustumRegion(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>(),
    Containment containment = Containment::touching, Touch touch = Touch::exact) {
    return ConvexRegion<Scalar>(
        std::span<const detail::Plane<Scalar>>(detail::frustumPlanes<Scalar>(
            viewProjection, depthRange, detail::edgesOf<Scalar>(rectangle))),
        containment, touch);
}

/// Returns the view through the whole screen as a region.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ConvexRegion<Scalar> frustumRegion(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    Containment containment, Touch touch = Touch::exact) {
    return frustumRegion<Scalar>(viewProjection, depthRange, wholeScreen<Scalar>(), containment,
                                 touch);
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
