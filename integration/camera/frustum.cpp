// SPDX-License-Identifier: Zlib
#include <integration/camera/frustum.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::detail {

template <class Scalar>
std::string frustumError(const Matrix4<Scalar>& viewProjection, const ScreenEdges<Scalar>& edges) {
    if (!viewProjection.allFinite()) {
        return "The view-projection matrix has a number that is NaN or infinite. Pass 16 finite "
               "numbers.";
    }
    const auto& [left, bottom, right, top] = edges;
    const bool isFinite =
        std::isfinite(left) && std::isfinite(bottom) && std::isfinite(right) && std::isfinite(top);
    if (!isFinite || left > right || bottom > top) {
        return "The rectangle of the screen is inverted or not finite. Pass finite corners, with "
               "min() not above max().";
    }
    if (viewProjection.row(3).isZero(0)) {
        return "The last row of the view-projection matrix is zero, so nothing is on the screen. "
               "Pass projection * view.";
    }
    return {};
}

template <class Scalar>
std::array<Plane<Scalar>, 6> frustumPlanes(const Matrix4<Scalar>& viewProjection,
                                           DepthRange depthRange,
                                           const ScreenEdges<Scalar>& edges) {
    std::array<Plane<Scalar>, 6> planes;
    if (!frustumError(viewProjection, edges).empty()) {
        for (auto& plane : planes) {
            plane.coeffs().setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        }
        return planes;
    }
    // A clip coordinate is a row times a point; a bound on it is a plane. In double precision, so that
    // small differences of large numbers are rounded once. A view is the same at any scale: halved until no
    // plane overflows.
    double farthestEdge = 1;
    for (const Scalar edge : edges) {
        farthestEdge = std::max(farthestEdge, std::abs(static_cast<double>(edge)));
    }
    const double most = std::numeric_limits<Scalar>::max() / 4 / farthestEdge;
    Matrix4<double> columns = viewProjection.transpose().template cast<double>();
    while (columns.cwiseAbs().maxCoeff() > most) {
        columns /= 2;
    }
    const Vector4<double> x = columns.col(0);
    const Vector4<double> y = columns.col(1);
    const Vector4<double> z = columns.col(2);
    const Vector4<double> w = columns.col(3);
    const auto set = [&](std::size_t i, const Vector4<double>& row) {
        planes[i].coeffs() = row.template cast<Scalar>();
    };
    const auto edge = [&](std::size_t i) { return static_cast<double>(edges[i]); };
    set(0, x - edge(0) * w);
    set(1, edge(2) * w - x);
    set(2, y - edge(1) * w);
    set(3, edge(3) * w - y);
    set(4, depthRange == DepthRange::zeroToOne ? z : Vector4<double>(w + z));
    set(5, w - z);
    return planes;
}

template std::string frustumError(const Matrix4<float>&, const ScreenEdges<float>&);
template std::string frustumError(const Matrix4<double>&, const ScreenEdges<double>&);
template std::array<Plane<float>, 6> frustumPlanes(const Matrix4<float>&, DepthRange,
                                                   const ScreenEdges<float>&);
template std::array<Plane<double>, 6> frustumPlanes(const Matrix4<double>&, DepthRange,
                                                    const ScreenEdges<double>&);

}  // namespace hashphase::detail
