// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies nearest to a point, measured to the centres of their boxes.
//
// Threads   Call from any thread while no thread changes the grid.
// Bad data  Finds nothing if `point` is not finite, or `maximalDistance` is negative or NaN. Never finds proxies
//           without a position (position_region.hpp).

#include <broadphase/collectors.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/export.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace hashphase {

/// Finds the `count` proxies nearest to `point` [m] that the filter accepts, at most `maximalDistance` [m] away (may
/// be infinite). Replaces `nearest`, sorted from near to far. Keys are squared distances [m^2]; equal keys are sorted
/// by id. Never finds `self`, usually the proxy that makes the query. May call the filter several times for a proxy.
/// Returns the cost. Cost: queries of balls. Each query doubles the radius of the previous query. If proxies are
/// evenly spread, a few queries suffice, and the last ball contains several times `count` proxies. Worst case: three
/// passes over the grid, plus a fixed cost for each query.
template <class Scalar>
HASHPHASE_AI_EXPORT QueryCost findNearest(const Grid<Scalar>& grid,
                                          const Vector3<std::type_identity_t<Scalar>>& point,
                                          std::size_t count,
                                          std::type_identity_t<Scalar> maximalDistance,
                                          std::vector<KeyedProxy<Scalar>>& nearest,
                                          ProxyFilter filter = acceptAll, ProxyId self = {});

}  // namespace hashphase
