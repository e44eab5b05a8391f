// SPDX-License-Identifier: Zlib
#pragma once

// Which proxies lie in a rectangle that is dragged on the screen. The rectangle is a frustum of the camera,
// not a piece of the ground, and so may reach over the horizon.
//
// Corners  two opposite ones, in any order. Equal corners, or corners in one row or column, select what lies
//          under that point or line. The part beside the viewport is cut off.
// Bad data A rectangle wholly beside the viewport, a NaN, or a camera that is not valid selects nothing;
//          selectionError() says why.
// Threads  any number at the same time, like every query of a grid

#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/camera/camera.hpp>
#include <integration/picking/export.hpp>

#include <string>
#include <vector>

namespace hashphase {

/// Says in a sentence why nothing can be selected; empty when something may be.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT std::string selectionError(const Camera<Scalar>& camera,
                                                                  const Pixel& a, const Pixel& b);

/// Returns the volume that is seen between two corners, exactly, for queries of your own. Cost: some
/// microseconds.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT ConvexRegion<Scalar> selectionRegion(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    Containment containment = Containment::touching);

/// Finds the proxies whose boxes touch the volume seen between two corners, or lie wholly inside. Replaces
/// what `selected` held; sorted by id. Returns the query's cost. Cost: at most one test for each proxy
/// (Grid::visit()), and sorting what is found.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost select(const Grid<Scalar>& grid, const Camera<Scalar>& camera,
                                          const Pixel& a, const Pixel& b,
                                          std::vector<ProxyId>& selected,
                                          Containment containment = Containment::touching,
                                          ProxyFilter filter = acceptAll);

}  // namespace hashphase
