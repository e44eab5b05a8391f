// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies in a rectangle dragged on the screen: a frustum of the camera, which may reach above the horizon.
//
// Corners   Two opposite ones, in any order. Equal corners, or corners in one row or column, select the proxies under
//           that point or line. The part outside the viewport is cut off.
// Bad data  A rectangle outside the viewport, a NaN, or an invalid camera selects nothing. selectionError() returns
//           the reason.
// Threads   Reads the grid, as queries do.

#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/camera/camera.hpp>
#include <integration/picking/export.hpp>

#include <string>
#include <vector>

namespace hashphase {

/// Returns in a sentence why nothing can be selected; empty if there is no fault.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::string selectionError(const Camera<Scalar>& camera,
                                                                  const Pixel& a, const Pixel& b);

/// Returns the exact volume seen between two corners, for your own queries. Cost: some microseconds.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT ConvexRegion<Scalar> selectionRegion(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    Containment containment = Containment::touching);

/// Finds the proxies whose boxes touch the volume between two corners, or are inside. Replaces `selected`, sorted by
/// id. Returns the cost. Cost: Grid::visit() of the volume, and sorting.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost select(const Grid<Scalar>& grid, const Camera<Scalar>& camera,
                                          const Pixel& a, const Pixel& b,
                                          std::vector<ProxyId>& selected,
                                          Containment containment = Containment::touching,
                                          ProxyFilter filter = acceptAll);

}  // namespace hashphase
