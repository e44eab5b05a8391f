// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies under the pointer, by their boxes or by an exact test of yours.
//
// Rays      Camera::rayThrough() makes one from a pixel. clipToHeights() (ground.hpp) cuts it to the heights of
//           objects.
// Order     From near to far; equally near proxies by id.
// Threads   Reads the grid, as queries do.
// Bad data  An empty ray (RayRegion::isEmpty()) picks nothing. An exact test that returns NaN, a negative number, or
//           more than the limit has found nothing.
// Cost      Grid::visit() of the ray, up to the proxy found, an exact test for each box that the ray meets, and
//           sorting. pickAll() returns the cost, pickNearest() adds it to `cost`.

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
    Scalar fraction = 0;                              ///< of the ray's length, where it meets
    Vector3<Scalar> point = Vector3<Scalar>::Zero();  ///< where it meets [m]
};

/// Returns where the ray meets the object of a proxy, as a fraction of the ray's length, or nothing. The fraction is
/// no smaller than where the ray enters the proxy's box. Hits beyond `limit` need not be found. Asked only about
/// proxies that the filter accepts and whose boxes the ray meets.
template <class Scalar>
using ExactTest =
    FunctionRef<std::optional<Scalar>(ProxyId id, const RayRegion<Scalar>& ray, Scalar limit)>;

/// Returns the nearest proxy whose box the ray meets.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(const Grid<Scalar>& grid,
                                                                  const RayRegion<Scalar>& ray,
                                                                  ProxyFilter filter = acceptAll,
                                                                  QueryCost* cost = nullptr);

/// Returns the nearest proxy by the exact test, which is not asked about boxes behind a hit.
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

/// Finds all proxies that the ray meets by the exact test. Replaces `picked`. Returns the cost.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           std::type_identity_t<ExactTest<Scalar>> test,
                                           ProxyFilter filter = acceptAll);

}  // namespace hashphase
