// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies near an agent, exactly or estimated by cells (paper, "AI proximity decisions").
//
// Distance  Between positions: the centres of boxes. A proxy exactly at the radius is found.
// Agent     Never finds `self`, usually the asking proxy.
// Results   Replace `found`: each proxy once, sorted by id. Allocates only if `found` has too little capacity.
// Threads   Call from any thread while no thread changes the grid.
// Bad data  Finds nothing if the position is not finite, or the radius is negative or NaN. An infinite radius finds
//           every proxy with a position (position_region.hpp).
// See also  nearest.hpp (n nearest); broadphase/radius_search.hpp and neighbours.hpp (all agents at once)

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the proxies whose positions are at most `radius` [m] from `position` [m]. Returns the cost. Cost:
/// Grid::visit() of the ball, and sorting.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findWithin(const Grid<Scalar>& grid,
                                         const Vector3<std::type_identity_t<Scalar>>& position,
                                         std::type_identity_t<Scalar> radius,
                                         std::vector<ProxyId>& found,
                                         ProxyFilter filter = acceptAll, ProxyId self = {});

/// Finds the proxies whose boxes touch any cell, of Grid::cellSize(), that the ball's box touches (cells_region.hpp).
/// These are all proxies within the radius, and other proxies at most sqrt(3) * (radius + cell size) away. With
/// agents half as large as cells, the ball contains 10 % of the found proxies at a radius of 1 cell, 20 % at 2, 30 %
/// at 4 and 40 % at 8 cells. For lists, findWithin() is faster. To count, with a radius of several cells, use
/// Grid::visit(CellsRegion, CollectCount). Returns the cost. Cost: at most as findWithin().
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost estimateWithin(const Grid<Scalar>& grid,
                                             const Vector3<std::type_identity_t<Scalar>>& position,
                                             std::type_identity_t<Scalar> radius,
                                             std::vector<ProxyId>& found,
                                             ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
