// SPDX-License-Identifier: Zlib
#pragma once

// Picking in flat worlds: all objects stand on the ground, between two heights.
//
// Units     metres
// Bad data  Results are empty for empty rays, and for heights that are NaN or inverted (low above high).
// Source    The paper's pick for 2D grids takes the point at which the ray meets the ground, and misses tall objects
//           in front of it. clipToHeights() follows the ray between the heights.

#include <broadphase/regions.hpp>
#include <integration/camera/camera.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/picking/export.hpp>

#include <optional>
#include <type_traits>

namespace hashphase {

/// Returns the part of a ray between the heights. Except for rounding, the part meets every box there that the whole
/// ray meets. Its fractions count from its beginning. Empty if the ray is never between the heights.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT RayRegion<Scalar> clipToHeights(
    const RayRegion<Scalar>& ray, const HeightRange<Scalar>& heights);

/// Returns the point [m] at which the ray meets the plane at this height [m]. Returns std::nullopt if the ray ends
/// before the plane, points away from it, or is parallel to it.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::optional<Vector3<Scalar>> groundPoint(
    const RayRegion<Scalar>& ray, std::type_identity_t<Scalar> height = 0, UpAxis up = UpAxis::y);

/// Returns the ground under a rectangle dragged on the screen (drag_selection.hpp, ground_footprint.hpp). To select
/// objects, query its region(), which includes the air above the ground.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline GroundFootprint<Scalar> dragFootprint(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    const HeightRange<Scalar>& heights, double farthest = kFarthestView) {
    return {camera.viewProjection(), camera.depthRange(), heights, camera.rectangleBetween(a, b),
            farthest};
}

}  // namespace hashphase
