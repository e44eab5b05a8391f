// SPDX-License-Identifier: Zlib
#pragma once

// The view of a camera as a convex region.
//
// Matrices  Any 4 x 4 matrix that transforms world coordinates, as columns (x, y, z, 1), to clip coordinates. It may
//           be perspective, orthographic or oblique, with a reversed depth range or an infinite far plane. Visible
//           points have -w <= x <= w, -w <= y <= w, and z in the DepthRange. For a column-major `const float* matrix`
//           (OpenGL, GLM, Vulkan), pass Eigen::Map<const Eigen::Matrix4f>(matrix) to frustumRegion<float>().
// Units     metres in the world; normalised device coordinates from -1 to 1 on the screen
// Bad data  If the matrix has a NaN, an infinity or a last row of zeros, or the rectangle is inverted or not finite,
//           nothing is visible: frustumError() returns the reason. Other singular matrices and transposed matrices
//           give a wrong view, but no error.

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

/// Range of z in clip space: from -w to w (minusOneToOne: OpenGL), or from 0 to w (zeroToOne: Direct3D, Vulkan,
/// Metal). The range is the same for reversed depths.
enum class DepthRange : std::uint8_t { minusOneToOne, zeroToOne };

/// A part of the screen in normalised device coordinates: x to the right, y upwards, from -1 to 1.
template <class Scalar>
using ScreenRectangle = Eigen::AlignedBox<Scalar, 2>;

/// Returns the rectangle from (-1, -1) to (1, 1).
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ScreenRectangle<Scalar> wholeScreen() {
    using Point = typename ScreenRectangle<Scalar>::VectorType;
    return {Point(-1, -1), Point(1, 1)};
}

namespace detail {

/// The left, bottom, right and top edges of a rectangle on the screen.
template <class Scalar>
using ScreenEdges = std::array<Scalar, 4>;

// Inlined into the program, because the libraries must not depend on the alignment of the program's Eigen types
// (core/unaligned.hpp).
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

/// Returns a sentence that explains why nothing is visible (see Bad data). Returns an empty string if there is no
/// such fault. Does not detect wrong views: test whether a known point is visible.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::string frustumError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>()) {
    return detail::frustumError<Scalar>(viewProjection, detail::edgesOf<Scalar>(rectangle));
}

/// Returns the planes of the view through the 4 x 4 matrix and a rectangle of the screen, in the order left, right,
/// bottom, top, near, far. The normals point inwards and are not normalised. If depths are reversed, near and far are
/// exchanged. If the far plane is infinite, every point is inside this plane. Source: Gribb and Hartmann, "Fast
/// Extraction of Viewing Frustum Planes from the World-View-Projection Matrix" (2001).
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

/// Returns the region that the planes of frustumPlanes() enclose. Cost: some microseconds.
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

/// Returns the region of the view through the whole screen.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline ConvexRegion<Scalar> frustumRegion(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    Containment containment, Touch touch = Touch::exact) {
    return frustumRegion<Scalar>(viewProjection, depthRange, wholeScreen<Scalar>(), containment,
                                 touch);
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
