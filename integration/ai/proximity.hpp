// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies are near an agent: exactly, or as an estimate by cells (paper, "AI proximity decisions").
// For the nearest n see findNearest() in integration/ai/nearest.hpp, for all agents at once
// broadphase/radius_search.hpp and broadphase/neighbours.hpp.
//
// Distance  from position to position, that is between the centres of boxes; the ball is closed.
// Agent     `self` is a proxy to leave out, as a rule the one that asks; null leaves out none.
// Results   replace what `found` held, each proxy once, sorted by id. Nothing is allocated where the vector
//           has room.
// Threads   Both functions read the grid, as queries do.
// Bad data  With a position that is not finite, or a negative or NaN radius, no proxy is found. An infinite
//           radius finds every proxy that has a position (position_region.hpp).

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the proxies whose position is within `radius` [m] of `position` [m]. Returns the cost. Cost: the
/// cells around, at most one test for each proxy, as Grid::visit() says, and sorting what is found.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findWithin(const Grid<Scalar>& grid,
                                         const Vector3<std::type_identity_t<Scalar>>& position,
                                         std::type_identity_t<Scalar> radius,
                                         std::vector<ProxyId>& found,
                                         ProxyFilter filter = acceptAll, ProxyId self = {});

/// Finds the proxies whose box touches a cell, of Grid::cellSize(), that the ball's box touches
/// (cells_region.hpp). These are all proxies within the radius, and others, none of whose boxes is farther
/// away than sqrt(3) * (radius + cell size). No distance is computed.
/// Of the proxies found, 1, 2, 3 and 4 in 10 are really within a radius of 1, 2, 4 and 8 cells, at any
/// density, where agents are half as large as the cells; never many more, as a ball fills about half of its
/// box. Saves time only where proxies are counted, by Grid::visit(CellsRegion, CollectCount), and the radius
/// is some cells; for lists findWithin() takes less. Cost: at most as findWithin().
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost estimateWithin(const Grid<Scalar>& grid,
                                             const Vector3<std::type_identity_t<Scalar>>& position,
                                             std::type_identity_t<Scalar> radius,
                                             std::vector<ProxyId>& found,
                                             ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
