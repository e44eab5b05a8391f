// SPDX-License-Identifier: Zlib
#pragma once

// Finds the proxies in a rectangle dragged on the screen. The rectangle may extend above the horizon.
//
// Corners   Pass two opposite corners in any order. If the corners are equal, or in one row or column, selects the
//           proxies under that point or line. Parts of the rectangle outside the viewport are ignored.
// Bad data  Nothing is selected if the rectangle is outside the viewport, a corner is NaN, or the camera is invalid.
//           selectionError() returns the reason.
// Threads   Call from any thread while no thread changes the grid.

#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/camera/camera.hpp>
#include <integration/picking/export.hpp>

#include <string>
#include <vector>

namespace hashphase {

/// Returns the reason why nothing can be selected. Returns an empty string if the selection is valid.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::string selectionError(const Camera<Scalar>& camera,
                                                                  const Pixel& a, const Pixel& b);

/// Returns the exact volume under the rectangle, for your own queries. Cost: some microseconds.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT ConvexRegion<Scalar> selectionRegion(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    Containment containment = Containment::touching);

/// Finds the proxies whose boxes touch the volume of selectionRegion(). With Containment::inside, the boxes must lie
/// wholly inside the volume. Replaces `selected`, sorted by id. Returns the cost. Cost: Grid::visit() of the volume,
/// and sorting.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost select(const Grid<Scalar>& grid, const Camera<Scalar>& camera,
                                          const Pixel& a, const Pixel& b,
                                          std::vector<ProxyId>& selected,
                                          Containment containment = Containment::touching,
                                          ProxyFilter filter = acceptAll);

}  // namespace hashphase
