// SPDX-License-Identifier: Zlib
#pragma once

// Who is nearest to a point, by position.
//
// Threads   Reads the grid, as queries do.
// Bad data  A point that is not finite, a negative or NaN distance: nobody is near. Proxies without
//           a position (position_region.hpp) are nowhere.

#include <broadphase/collectors.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the `count` proxies nearest to `point` whose positions are at most `maximalDistance` [m]
/// away, which may be infinite, of those that the filter accepts: into `nearest`, which is emptied
/// first, from near to far with the squared distances [m^2] as keys, of equal ones the smallest ids
/// first. Fewer when there are fewer. `self` is a proxy to leave out, as a rule the one that asks; null
/// for nobody. The filter may be asked about a proxy several times.
///
/// Looks in balls of growing size. Cost: a few balls that hold about `count`, where proxies are as
/// dense as at the point; at most that of reading the grid three times and once for every doubling
/// of the distance.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findNearest(const Grid<Scalar>& grid,
                                          const Vector3<std::type_identity_t<Scalar>>& point,
                                          std::size_t count,
                                          std::type_identity_t<Scalar> maximalDistance,
                                          std::vector<KeyedProxy<Scalar>>& nearest,
                                          ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
