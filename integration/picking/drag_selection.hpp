// SPDX-License-Identifier: Zlib
#pragma once

// What lies in a rectangle that is dragged on the screen. The rectangle is a frustum of the camera, not a
// piece of the ground, and so may reach over the horizon.
//
// Corners  two opposite ones, in any order. Those of the same place, row or column select what lies
//          under that point or line. What lies beside the viewport is cut off.
// Bad data A rectangle that lies wholly beside the viewport or is NaN, and a camera that is not valid,
//          select nothing; selectionError() says why.
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

/// All that is seen between two corners, exactly. Cost: some microseconds.
template <class Scalar>
[[nodiscard]] HASHPHASE_PICKING_EXPORT ConvexRegion<Scalar> selectionRegion(
    const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
    Containment containment = Containment::touching);

/// The proxies whose boxes touch what is seen between two corners, or lie wholly inside, sorted, in place
/// of what `selected` held. Returns the query's cost. Cost: at most one test for each proxy
/// (Grid::visit()), and sorting what is found.
template <class Scalar>
HASHPHASE_PICKING_EXPORT QueryCost select(const Grid<Scalar>& grid, const Camera<Scalar>& camera,
                                          const Pixel& a, const Pixel& b,
                                          std::vector<ProxyId>& selected,
                                          Containment containment = Containment::touching,
                                          ProxyFilter filter = acceptAll);

}  // namespace hashphase
