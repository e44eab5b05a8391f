// SPDX-License-Identifier: Zlib
#pragma once

// Picking in worlds that are flat, more or less: everything stands on the ground, between two heights.
// The forms that the paper gives for 2D grids, corrected: a pick follows the ray's way between the
// heights, not only the point where it meets the ground's plane, which misses whatever has height in
// front of that point; and a drag rectangle is the polygon that its corners cast on the ground.
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

/// The part of a ray between the heights: of what stands there, it meets what the ray meets, but for
/// rounding. Its fractions count from where it begins. Empty when the ray never comes there.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT RayRegion<Scalar> clipToHeights(
    const RayRegion<Scalar>& ray, const HeightRange<Scalar>& heights);

/// Where the ray meets the plane at this height; nothing for a ray that ends before, looks over the
/// horizon, or is parallel to the ground.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::optional<Vector3<Scalar>> groundPoint(
    const RayRegion<Scalar>& ray, std::type_identity_t<Scalar> height = 0, UpAxis up = UpAxis::y);

/// What a rectangle that is dragged on the screen covers on the ground (see drag_selection.hpp and
/// ground_footprint.hpp). Select by its region(): all columns of air over it count, as on a map.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT GroundFootprint<Scalar> dragFootprint(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    const HeightRange<Scalar>& heights, double farthest = kFarthestView);

}  // namespace hashphase
