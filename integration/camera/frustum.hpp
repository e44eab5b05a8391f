// SPDX-License-Identifier: Zlib
#pragma once

// What a camera sees, as a convex region.
//
// Matrices  any view-projection matrix that maps world coordinates (columns: x, y, z, 1) to clip
//           coordinates: perspective or orthographic, oblique, with a reversed or an infinite far
//           plane. What is seen are the points with -w <= x <= w, -w <= y <= w, and z by DepthRange.
//           One of OpenGL, GLM or Vulkan, column by column from `const float* matrix`, is
//           Eigen::Map<const Eigen::Matrix4f>(matrix), as an argument of frustumRegion<float>().
// Units     metres in the world; normalised device coordinates from -1 to 1 on the screen.
// Bad data  A matrix that is NaN or infinite sees nothing; frustumError() says why. A singular one
//           sees what its planes enclose: a line of sight, a sheet, nothing. A transposed one is that of
//           some other camera, which nothing can tell.

#include <broadphase/aabb.hpp>
#include <broadphase/convex_region.hpp>
#include <integration/camera/export.hpp>

#include <array>
#include <cstdint>
#include <string>

namespace hashphase {

/// Between which depths clip space reaches: z from -w to w (OpenGL), or from 0 to w (Direct3D, Vulkan,
/// Metal; a reversed depth range as well).
enum class DepthRange : std::uint8_t { minusOneToOne, zeroToOne };

/// Part of the screen in normalised device coordinates: x to the right, y upwards, from -1 to 1.
template <class Scalar>
using ScreenRectangle = Eigen::AlignedBox<Scalar, 2>;

template <class Scalar>
[[nodiscard]] ScreenRectangle<Scalar> wholeScreen() {
    using Point = typename ScreenRectangle<Scalar>::VectorType;
    return {Point(-1, -1), Point(1, 1)};
}

/// Says in a sentence why nothing can be seen through the matrix, 4 x 4, or through that part of the
/// screen; empty when something may be. Not whether that is what was meant: of a point that the camera is
/// known to see, `viewProjection * (x, y, z, 1)` has -w <= x <= w and -w <= y <= w.
template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string frustumError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>());

/// The planes left, right, bottom, top, near and far of what is seen through the matrix, 4 x 4, in a
/// rectangle of the screen, all facing inwards; with a reversed depth range near and far change
/// places, and an infinite far plane has everything inside. Not normalised. After Gribb and Hartmann,
/// "Fast Extraction of Viewing Frustum Planes from the World-View-Projection Matrix" (2001).
template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::array<Eigen::Hyperplane<Scalar, 3>, 6> frustumPlanes(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>());

/// The same as a region. Cost: some microseconds.
template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT ConvexRegion<Scalar> frustumRegion(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>(),
    Containment containment = Containment::touching, Touch touch = Touch::exact) {
    return ConvexRegion<Scalar>(frustumPlanes(viewProjection, depthRange, rectangle), containment,
                                touch);
}

/// The same for the whole screen.
template <class Scalar>
[[nodiscard]] ConvexRegion<Scalar> frustumRegion(const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
                                                 DepthRange depthRange, Containment containment,
                                                 Touch touch = Touch::exact) {
    return frustumRegion(viewProjection, depthRange, wholeScreen<Scalar>(), containment, touch);
}

}  // namespace hashphase
