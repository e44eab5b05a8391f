// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies near an agent, exactly or as an estimate by cells (paper, "AI proximity decisions").
//
// Distance  Between positions, that is centres of boxes. The ball is closed.
// Agent     Leaves out `self`, usually the asking proxy, if not null.
// Results   Replace `found`: each proxy once, sorted by id. Allocates nothing if the vector has room.
// Threads   Reads the grid, as queries do.
// Bad data  Finds nothing with a position that is not finite, or a negative or NaN radius. An infinite radius finds
//           every proxy with a position (position_region.hpp).
// Others    nearest.hpp for the n nearest; broadphase/radius_search.hpp and neighbours.hpp for all agents at once

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the proxies whose position is within `radius` [m] of `position` [m]. Returns the cost. Cost: Grid::visit()
/// of the ball, and sorting.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findWithin(const Grid<Scalar>& grid,
                                         const Vector3<std::type_identity_t<Scalar>>& position,
                                         std::type_identity_t<Scalar> radius,
                                         std::vector<ProxyId>& found,
                                         ProxyFilter filter = acceptAll, ProxyId self = {});

/// Finds the proxies whose box touches a cell, of Grid::cellSize(), that the ball's box touches (cells_region.hpp).
/// These are all proxies within the radius, and others, none farther away than sqrt(3) * (radius + cell size). With
/// agents half as large as cells, and radii of 1, 2, 4 and 8 cells, 1, 2, 3 and 4 in 10 of these are within the
/// radius. findWithin() lists faster. To count, with a radius of several cells, use Grid::visit(CellsRegion,
/// CollectCount). Returns the cost. Cost: at most as findWithin().
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost estimateWithin(const Grid<Scalar>& grid,
                                             const Vector3<std::type_identity_t<Scalar>>& position,
                                             std::type_identity_t<Scalar> radius,
                                             std::vector<ProxyId>& found,
                                             ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
