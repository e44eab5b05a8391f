// SPDX-License-Identifier: Zlib
#pragma once

// Who is near an agent: exactly, or as an estimate by cells (paper, "AI proximity decisions"). The
// nearest n: findNearest() in integration/ai/nearest.hpp. All agents at once: broadphase/neighbours.hpp.
//
// Distance  from position to position, that is between the centres of boxes; the ball is closed.
// Agent     `self` is a proxy to leave out, as a rule the one that asks; null for nobody.
// Results   replace what `found` held, each proxy once, sorted. Nothing is allocated where the
//           vector has room.
// Threads   Read the grid, as queries do.
// Bad data  A position that is not finite, a negative or NaN radius: nobody is near. An infinite
//           radius finds everybody who has a position (position_region.hpp).

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds those whose position is within `radius` [m] of `position`. Cost: the cells around, at most
/// one test for each proxy, as Grid::visit() says, and sorting what is found.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findWithin(const Grid<Scalar>& grid,
                                         const Vector3<std::type_identity_t<Scalar>>& position,
                                         std::type_identity_t<Scalar> radius,
                                         std::vector<ProxyId>& found,
                                         ProxyFilter filter = acceptAll, ProxyId self = {});

/// Finds those whose box touches a cell, of Grid::cellSize(), that the ball's box touches
/// (cells_region.hpp): all who are within the radius, and others, none of whose boxes is farther away
/// than sqrt(3) * (radius + cell size). No distance is computed. Of agents half as large as the
/// cells, those found that are really within are 1, 2, 3 and 4 in 10 where the radius is 1, 2, 4 and
/// 8 cells, at any density; a ball fills about half of its box, so it is never many more. Saves time
/// where they are only counted, by Grid::visit(CellsRegion, CollectCount), and the radius is some
/// cells: in lists, and within a cell in space, the exact ones take less. Cost: at most as above.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost estimateWithin(const Grid<Scalar>& grid,
                                             const Vector3<std::type_identity_t<Scalar>>& position,
                                             std::type_identity_t<Scalar> radius,
                                             std::vector<ProxyId>& found,
                                             ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
