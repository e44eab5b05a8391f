// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies are under the pointer: by boxes, or by an exact test of the caller. Users and AI alike pick
// along a ray: Camera::rayThrough() makes one of a pixel, clipToHeights() (ground.hpp) cuts it to the heights
// where objects stand.
//
//     const Picked<float> picked = pickNearest(grid, camera.rayThrough(pixel));
//     if (!picked.id.isNull()) { select(objects[picked.id.index]); }
//
// Order    from near to far; equally near ones by their ids
// Threads  any number at the same time, like every query of a grid
// Bad data An empty ray (RayRegion::isEmpty()) picks nothing. An exact test that returns NaN, a number below
//          0, or one above the limit has found nothing.
// Cost     the boxes near the ray, up to the proxy found; however long the ray, at most one test for each
//          proxy (Grid::visit()), an exact one for each box that the ray meets, and sorting these. pickAll()
//          returns the query's cost, pickNearest() adds it to `cost` if this is given.

#include <broadphase/function_ref.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/picking/export.hpp>

#include <optional>
#include <type_traits>
#include <vector>

namespace hashphase {

/// What a ray has met, and where.
template <class Scalar>
struct Picked {
    ProxyId id;                                       ///< isNull(): the ray has met nothing
    Scalar fraction = 0;                              ///< of the ray's length, where it meets
    Vector3<Scalar> point = Vector3<Scalar>::Zero();  ///< where it meets [m]
};

/// Returns where the ray meets the object of a proxy: the fraction of the ray's length, no smaller than that
/// at which the ray enters the proxy's box; or nothing. Hits beyond `limit` are not wanted and need not be
/// found. Asked only about proxies that the filter accepts and whose boxes the ray meets.
template <class Scalar>
using ExactTest =
    FunctionRef<std::optional<Scalar>(ProxyId id, const RayRegion<Scalar>& ray, Scalar limit)>;

/// Returns the nearest proxy whose box the ray meets.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(const Grid<Scalar>& grid,
                                                                  const RayRegion<Scalar>& ray,
                                                                  ProxyFilter filter = acceptAll,
                                                                  QueryCost* cost = nullptr);

/// Returns the nearest proxy by the exact test. The test is not asked about boxes behind a hit found before.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(
    const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
    std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter = acceptAll,
    QueryCost* cost = nullptr);

/// Finds all proxies whose boxes the ray meets, from near to far. Replaces what `picked` held.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           ProxyFilter filter = acceptAll);

/// Finds all proxies that the ray meets by the exact test, from near to far. Replaces what `picked` held.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           std::type_identity_t<ExactTest<Scalar>> test,
                                           ProxyFilter filter = acceptAll);

}  // namespace hashphase
