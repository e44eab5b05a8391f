// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies near an agent, exactly or approximately (paper, "AI proximity decisions").
//
// Distance  Measured to the centres of boxes. A proxy exactly at the radius is found.
// Agent     Pass the agent's own proxy as `self`: `self` is never found.
// Results   Replaces `found`: each proxy once, sorted by id. Allocates only if `found` has too little capacity.
// Threads   Call from any thread while no thread changes the grid.
// Bad data  Finds nothing if the position is not finite, or the radius is negative or NaN. An infinite radius finds
//           every proxy that has a position (position_region.hpp).
// See also  nearest.hpp (n nearest proxies); broadphase/radius_search.hpp and neighbours.hpp (all agents at once)

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

/// Finds every proxy whose box touches a cell (size: Grid::cellSize()) that the ball's bounding box touches
/// (cells_region.hpp). Finds all proxies within the radius, and some other proxies, whose boxes are at most
/// sqrt(3) * (radius + cell size) away. If agents are half as large as cells, only a part of the found proxies is
/// within the radius: 10 % for a radius of 1 cell, 20 % for 2, 30 % for 4 and 40 % for 8 cells. To list proxies,
/// findWithin() is faster. To estimate how many proxies are within a radius of several cells, use Grid::visit() with
/// CellsRegion and CollectCount. Returns the cost. Cost: Grid::visit() of the cells, and sorting.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost estimateWithin(const Grid<Scalar>& grid,
                                             const Vector3<std::type_identity_t<Scalar>>& position,
                                             std::type_identity_t<Scalar> radius,
                                             std::vector<ProxyId>& found,
                                             ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
