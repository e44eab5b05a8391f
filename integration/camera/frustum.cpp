// SPDX-License-Identifier: Zlib
#include <integration/camera/frustum.hpp>

#include <limits>

namespace hashphase {

template <class Scalar>
std::string frustumError(const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
                         const ScreenRectangle<Scalar>& rectangle) {
    if (!viewProjection.allFinite()) {
        return "The view-projection matrix has a number that is NaN or infinite; all 16 must be "
               "finite.";
    }
    if (!rectangle.min().allFinite() || !rectangle.max().allFinite() || rectangle.isEmpty()) {
        return "The rectangle of the screen must have finite corners, min() not above max().";
    }
    if (viewProjection.row(3).isZero(0)) {
        return "The last row of the view-projection matrix is zero: nothing has a place on the "
               "screen.";
    }
    return {};
}

template <class Scalar>
std::array<Eigen::Hyperplane<Scalar, 3>, 6> frustumPlanes(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    const ScreenRectangle<Scalar>& rectangle) {
    std::array<Eigen::Hyperplane<Scalar, 3>, 6> planes;
    if (!frustumError(viewProjection, rectangle).empty()) {
        for (auto& plane : planes) {
            plane.coeffs().setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        }
        return planes;
    }
    // A clip coordinate is a row times a point; a bound on it is a plane. In double precision, so that
    // small differences of large numbers are rounded once.
    const auto rows = viewProjection.template cast<double>().eval();
    const auto set = [&](std::size_t i, const Eigen::RowVector4d& row) {
        planes[i].coeffs() = row.transpose().template cast<Scalar>();
    };
    const auto low = rectangle.min().template cast<double>().eval();
    const auto high = rectangle.max().template cast<double>().eval();
    set(0, rows.row(0) - low.x() * rows.row(3));
    set(1, high.x() * rows.row(3) - rows.row(0));
    set(2, rows.row(1) - low.y() * rows.row(3));
    set(3, high.y() * rows.row(3) - rows.row(1));
    set(4, depthRange == DepthRange::zeroToOne ? Eigen::RowVector4d(rows.row(2))
                                               : Eigen::RowVector4d(rows.row(3) + rows.row(2)));
    set(5, rows.row(3) - rows.row(2));
    return planes;
}

template std::string frustumError(const Eigen::Matrix4f&, const ScreenRectangle<float>&);
template std::string frustumError(const Eigen::Matrix4d&, const ScreenRectangle<double>&);
template std::array<Eigen::Hyperplane<float, 3>, 6> frustumPlanes(const Eigen::Matrix4f&,
                                                                  DepthRange,
                                                                  const ScreenRectangle<float>&);
template std::array<Eigen::Hyperplane<double, 3>, 6> frustumPlanes(const Eigen::Matrix4d&,
                                                                   DepthRange,
                                                                   const ScreenRectangle<double>&);

}  // namespace hashphase
