// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies nearest to a point, by position.
//
// Threads   Reads the grid, as queries do.
// Bad data  Finds nothing with a point that is not finite, or a negative or NaN distance. Never finds proxies without
//           a position (position_region.hpp).

#include <broadphase/collectors.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the `count` accepted proxies nearest to `point` [m], at most `maximalDistance` [m] away, which may be
/// infinite. Replaces `nearest`: near to far, with squared distances [m^2] as keys; of equal keys the smallest id
/// first. Leaves out `self`, usually the asking proxy, if not null. May ask the filter about a proxy several times.
/// Returns the cost. Cost: searches growing balls: a few that hold about `count` proxies if density is even; at most
/// as reading the grid three times, and once for each doubling of the distance.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findNearest(const Grid<Scalar>& grid,
                                          const Vector3<std::type_identity_t<Scalar>>& point,
                                          std::size_t count,
                                          std::type_identity_t<Scalar> maximalDistance,
                                          std::vector<KeyedProxy<Scalar>>& nearest,
                                          ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
