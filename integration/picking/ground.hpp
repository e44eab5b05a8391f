// SPDX-License-Identifier: Zlib
#pragma once

// Picking in worlds that are more or less flat: everything stands on the ground, between two heights.
// Corrects the forms that the paper gives for 2D grids. There a pick asks for the point where the ray meets
// the ground's plane, and misses objects with a height in front of that point; here it follows the ray
// between the heights. A drag rectangle is the polygon that its corners cast on the ground.
//
// Units     metres
// Bad data  Empty rays and heights that are NaN or exchanged meet nothing.

#include <broadphase/regions.hpp>
#include <integration/camera/camera.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/picking/export.hpp>

#include <optional>
#include <type_traits>

namespace hashphase {

/// Returns the part of a ray between the heights. Between them it meets every box that the whole ray meets,
/// but for rounding. Its fractions count from where the part begins. Empty when the ray never comes there.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT RayRegion<Scalar> clipToHeights(
    const RayRegion<Scalar>& ray, const HeightRange<Scalar>& heights);

/// Returns the point [m] where the ray meets the plane at this height [m]; nothing for a ray that ends before
/// the plane, looks over the horizon, or is parallel to the ground.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::optional<Vector3<Scalar>> groundPoint(
    const RayRegion<Scalar>& ray, std::type_identity_t<Scalar> height = 0, UpAxis up = UpAxis::y);

/// Returns the part of the ground under a rectangle that is dragged on the screen (see drag_selection.hpp and
/// ground_footprint.hpp). Select by its region(), which counts the air above the ground too, as on a map.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline GroundFootprint<Scalar> dragFootprint(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    const HeightRange<Scalar>& heights, double farthest = kFarthestView) {
    return {camera.viewProjection(), camera.depthRange(), heights, camera.rectangleBetween(a, b),
            farthest};
}

}  // namespace hashphase
