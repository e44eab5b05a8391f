// SPDX-License-Identifier: Zlib
#include <broadphase/detail/camera_inverse.hpp>

#include <Eigen/LU>

namespace hashphase::detail {

CameraInverse::CameraInverse(const Eigen::Matrix4d& viewProjection)
    : weightPerMetre_(viewProjection.block<1, 3>(3, 0).stableNorm()) {
    if (!viewProjection.allFinite()) {
        return;
    }
    // Rows and columns of like size: a camera far from the origin, or with planes near 0 and far
    // away, is no less regular than any other.
    Eigen::Matrix4d scaled = viewProjection;
    const Eigen::Vector4d rows = scaled.cwiseAbs().rowwise().maxCoeff();
    scaled = rows.cwiseInverse().asDiagonal() * scaled;
    const Eigen::Vector4d columns = scaled.cwiseAbs().colwise().maxCoeff();
    scaled = scaled * columns.cwiseInverse().asDiagonal();
    if (!scaled.allFinite()) {
        return;  // a row or a column is zero
    }
    Eigen::FullPivLU<Eigen::Matrix4d> factors(scaled);
    factors.setThreshold(1e-14);
    if (factors.isInvertible()) {
        inverse_ = columns.cwiseInverse().asDiagonal() * factors.inverse() *
                   rows.cwiseInverse().asDiagonal();
        isValid_ = inverse_.allFinite();
    }
}

}  // namespace hashphase::detail
