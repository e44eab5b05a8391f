// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies are nearest to a point, by position.
//
// Threads   Reads the grid, as queries do.
// Bad data  With a point that is not finite, or a negative or NaN distance, no proxy is found. Proxies
//           without a position (position_region.hpp) are never found.

#include <broadphase/collectors.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the `count` proxies nearest to `point` [m] that the filter accepts and whose positions are at most
/// `maximalDistance` [m] away, which may be infinite. Replaces what `nearest` held: from near to far, with
/// the squared distances [m^2] as keys, of equal keys the smallest id first. Finds fewer when there are
/// fewer. Leaves out `self`, as a rule the proxy that asks; null leaves out none. The filter may be asked
/// about a proxy several times. Returns the cost.
///
///     std::vector<KeyedProxy<float>> nearest;
///     findNearest(grid, positionOf(grid.box(agent)), 5, 100, nearest, acceptAll, agent);
///
/// Looks in balls of growing size. Cost: a few balls that hold about `count` proxies, where proxies are as
/// dense as at the point; at most reading the grid three times, and once for every doubling of the distance.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findNearest(const Grid<Scalar>& grid,
                                          const Vector3<std::type_identity_t<Scalar>>& point,
                                          std::size_t count,
                                          std::type_identity_t<Scalar> maximalDistance,
                                          std::vector<KeyedProxy<Scalar>>& nearest,
                                          ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
