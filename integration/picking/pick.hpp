// SPDX-License-Identifier: Zlib
#pragma once

// What is under the pointer: by boxes, or by an exact test of the caller's. Users and AI alike pick
// along a ray: Camera::rayThrough() makes one of a pixel, clipToHeights() shortens it to where things
// stand.
//
// Order    from near to far; of those equally near, by their ids
// Threads  any number at the same time, like every query of a grid
// Bad data An empty ray (RayRegion::isEmpty()) picks nothing. An exact test that answers NaN, a number
//          below 0, or one above the limit has found nothing.
// Cost     what lies near the ray, up to what is found; however long the ray, at most one test for each
//          proxy (Grid::visit()), an exact one for each box that is met, and sorting these. That of the
//          query is returned, or, where what is picked is, added to `cost` if that is given.

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
    ProxyId id;                                       // isNull(): nothing is met
    Scalar fraction = 0;                              // of the ray's length, at which it is met
    Vector3<Scalar> point = Vector3<Scalar>::Zero();  // there [m]
};

/// Says where the ray meets what the proxy stands for: the fraction of its length, no smaller than
/// that at which the ray enters the proxy's box, or nothing. What is farther away than `limit` is not
/// wanted and need not be looked for. Asked about what the filter accepts and whose box is met.
template <class Scalar>
using ExactTest =
    FunctionRef<std::optional<Scalar>(ProxyId id, const RayRegion<Scalar>& ray, Scalar limit)>;

/// The nearest proxy whose box the ray meets.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(const Grid<Scalar>& grid,
                                                                  const RayRegion<Scalar>& ray,
                                                                  ProxyFilter filter = acceptAll,
                                                                  QueryCost* cost = nullptr);

/// The nearest by the exact test, which is not asked about boxes behind what was found before.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT Picked<Scalar> pickNearest(
    const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
    std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter = acceptAll,
    QueryCost* cost = nullptr);

/// All that the ray meets, near to far, in place of what `picked` held.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           ProxyFilter filter = acceptAll);

/// The same by the exact test.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                           std::vector<Picked<Scalar>>& picked,
                                           std::type_identity_t<ExactTest<Scalar>> test,
                                           ProxyFilter filter = acceptAll);

}  // namespace hashphase
