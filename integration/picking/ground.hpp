// SPDX-License-Identifier: Zlib
#pragma once

// Picking in flat worlds, in which all objects are between two heights.
//
// Units     metres
// Bad data  Results are empty if the ray is empty, a height is NaN, or `low` is above `high`.
// Source    Hastings, Mesit and Guha pick at the point at which the ray meets the ground (in 2D grids). This misses
//           tall objects in front of the point. Instead, query with clipToHeights(): the part of the ray between the
//           heights.

#include <broadphase/regions.hpp>
#include <integration/camera/camera.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/picking/export.hpp>

#include <optional>
#include <type_traits>

namespace hashphase {

/// Returns the part of a ray between the heights; of a fat ray, the part on which its box touches the space between
/// the heights. If a box lies wholly between the heights and the whole ray meets it, this part meets it too, except
/// for rounding. If you query with this part, results such as Picked::fraction are fractions of it, not of the whole
/// ray. Returns an empty ray if there is no such part.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT RayRegion<Scalar> clipToHeights(
    const RayRegion<Scalar>& ray, const HeightRange<Scalar>& heights);

/// Returns the point [m] at which the ray meets the plane at this height [m]. Returns std::nullopt if the ray ends
/// before the plane, points away from it, or is parallel to it.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::optional<Vector3<Scalar>> groundPoint(
    const RayRegion<Scalar>& ray, std::type_identity_t<Scalar> height = 0, UpAxis up = UpAxis::y);

/// Returns the footprint of a rectangle on the screen (drag_selection.hpp, ground_footprint.hpp). To select objects,
/// query GroundFootprint::region(), which extends over all of `heights`.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline GroundFootprint<Scalar> dragFootprint(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    const HeightRange<Scalar>& heights, double farthest = kFarthestView) {
    return {camera.viewProjection(), camera.depthRange(), heights, camera.rectangleBetween(a, b),
            farthest};
}

}  // namespace hashphase
