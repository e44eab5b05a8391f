// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies under the pointer: tests their boxes, or calls your own exact test.
//
// Rays      Camera::rayThrough() makes a ray from a pixel. clipToHeights() (ground.hpp) shortens a ray to a range of
//           heights.
// Order     Results are sorted from near to far. Equally near proxies are sorted by id.
// Threads   Call from any thread while no thread changes the grid.
// Bad data  An empty ray (RayRegion::isEmpty()) picks nothing. If an exact test returns NaN, a negative number, or
//           more than `limit`, the proxy is not hit.
// Cost      Grid::visit() of the ray, one exact test for each box that the ray meets, and sorting. pickNearest()
//           stops at the nearest hit. pickAll() returns the cost. pickNearest() adds the cost to `cost`.

#include <broadphase/function_ref.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/picking/export.hpp>

#include <optional>
#include <type_traits>
#include <vector>

namespace hashphase {

/// A hit of a ray.
template <class Scalar>
struct Picked {
    ProxyId id;                                       ///< isNull() if the ray meets nothing
    Scalar fraction = 0;                              ///< distance to the hit / length of the ray
    Vector3<Scalar> point = Vector3<Scalar>::Zero();  ///< of the hit [m]
};

/// Returns the fraction of the ray's length at which the ray meets the object of a proxy. Returns std::nullopt if
/// there is no hit. This fraction must not be less than the fraction at which the ray enters the proxy's box: the
/// object must lie within its box. The test may ignore hits beyond the fraction `limit`. Called only for proxies that
/// the filter accepts and whose boxes the ray meets.
template <class Scalar>
using ExactTest =
    FunctionRef<std::optional<Scalar>(ProxyId id, const RayRegion<Scalar>& ray, Scalar limit)>;

/// Returns the nearest proxy whose box the ray meets.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(const Grid<Scalar>& grid,
                                                                  const RayRegion<Scalar>& ray,
                                                                  ProxyFilter filter = acceptAll,
                                                                  QueryCost* cost = nullptr);

/// Returns the nearest proxy according to the exact test. Does not call the test for boxes that the ray enters
/// beyond a hit that the test has already returned.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(
    const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
    std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter = acceptAll,
    QueryCost* cost = nullptr);

/// Finds all proxies whose boxes the ray meets. Replaces `picked`. Returns the cost.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           ProxyFilter filter = acceptAll);

/// Finds all proxies that the ray meets according to the exact test. Replaces `picked`. Returns the cost.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           std::type_identity_t<ExactTest<Scalar>> test,
                                           ProxyFilter filter = acceptAll);

}  // namespace hashphase
