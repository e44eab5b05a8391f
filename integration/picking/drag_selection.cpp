// SPDX-License-Identifier: Zlib
#include <integration/picking/drag_selection.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace hashphase {
namespace {

// Not camera.viewProjection(): a matrix of the program's lies otherwise (core/unaligned.hpp).
template <class Scalar>
detail::Matrix4<Scalar> matrixOf(const Camera<Scalar>& camera) {
    return camera.template viewProjection<detail::Matrix4<Scalar>>();
}

}  // namespace

template <class Scalar>
std::string selectionError(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b) {
    if (!camera.isValid()) {
        return detail::cameraError<Scalar>(matrixOf(camera), camera.viewport());
    }
    if (a.hasNaN() || b.hasNaN()) {
        return "A corner of the rectangle is NaN. Pass two positions in the window [pixels].";
    }
    const auto [left, bottom, right, top] = camera.edgesBetween(a, b);
    if (left > right || bottom > top) {
        return "The rectangle lies outside the viewport. Pass one that overlaps it [pixels].";
    }
    return {};
}

template <class Scalar>
ConvexRegion<Scalar> selectionRegion(const Camera<Scalar>& camera, const Pixel& a, const Pixel& b,
                                     Containment containment) {
    const std::array<detail::Plane<Scalar>, 6> planes = detail::frustumPlanes<Scalar>(
        matrixOf(camera), camera.depthRange(), camera.edgesBetween(a, b));
    return ConvexRegion<Scalar>(std::span<const detail::Plane<Scalar>>(planes), containment,
                                Touch::exact);
}

template <class Scalar>
QueryCost select(const Grid<Scalar>& grid, const Camera<Scalar>& camera, const Pixel& a,
                 const Pixel& b, std::vector<ProxyId>& selected, Containment containment,
                 ProxyFilter filter) {
    selected.clear();
    CollectAll all(selected);
    CollectIf accepted(all, filter);
    const QueryCost cost = grid.visit(selectionRegion(camera, a, b, containment), accepted);
    std::sort(selected.begin(), selected.end());
    return cost;
}

#define HASHPHASE_INSTANTIATE(Scalar)                                                              \
    template std::string selectionError(const Camera<Scalar>&, const Pixel&, const Pixel&);        \
    template ConvexRegion<Scalar> selectionRegion(const Camera<Scalar>&, const Pixel&,             \
                                                  const Pixel&, Containment);                      \
    template QueryCost select(const Grid<Scalar>&, const Camera<Scalar>&, const Pixel&,            \
                              const Pixel&, std::vector<ProxyId>&, Containment, ProxyFilter)

HASHPHASE_INSTANTIATE(float);
HASHPHASE_INSTANTIATE(double);
#undef HASHPHASE_INSTANTIATE

}  // namespace hashphase
