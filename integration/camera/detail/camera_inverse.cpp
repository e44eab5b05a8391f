// SPDX-License-Identifier: Zlib
#include <integration/camera/detail/camera_inverse.hpp>

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace hashphase::detail {
namespace {

// None for a matrix that is singular or not finite.
std::optional<Eigen::Matrix4d> inverseOf(const Eigen::Matrix4d& matrix) {
    if (!matrix.allFinite()) {
        return std::nullopt;
    }
    // Rows and columns of like size: a camera far from the origin, or with planes near 0 and far
    // away, is no less regular than any other.
    Eigen::Matrix4d scaled = matrix;
    const Eigen::Vector4d rows = scaled.cwiseAbs().rowwise().maxCoeff();
    scaled = rows.cwiseInverse().asDiagonal() * scaled;
    const Eigen::Vector4d columns = scaled.cwiseAbs().colwise().maxCoeff();
    scaled = scaled * columns.cwiseInverse().asDiagonal();
    if (!scaled.allFinite()) {
        return std::nullopt;  // a row or a column is zero
    }
    Eigen::FullPivLU<Eigen::Matrix4d> factors(scaled);
    factors.setThreshold(1e-14);
    if (!factors.isInvertible()) {
        return std::nullopt;
    }
    Eigen::Matrix4d inverse =
        columns.cwiseInverse().asDiagonal() * factors.inverse() * rows.cwiseInverse().asDiagonal();
    return inverse.allFinite() ? std::optional(inverse) : std::nullopt;
}

}  // namespace

CameraInverse::CameraInverse(const Eigen::Matrix4d& viewProjection)
    : weightPerMetre_(viewProjection.block<1, 3>(3, 0).stableNorm()) {
    const std::optional<Eigen::Matrix4d> inverse = inverseOf(viewProjection);
    if (!inverse) {
        return;
    }
    inverse_ = *inverse;
    isValid_ = true;
    // Whichever way depth runs, the nearer of these is in front of the eye, and not at infinity.
    const Eigen::Vector4d first = at(0, 0, 0);
    const Eigen::Vector4d second = at(0, 0, 1);
    const Eigen::Vector4d& near = std::abs(first.w()) > std::abs(second.w()) ? first : second;
    const Eigen::Vector3d origin = near.head<3>() / near.w();
    Eigen::Matrix4d shifted = viewProjection;
    shifted.col(3) += viewProjection.leftCols<3>() * origin;
    if (const std::optional<Eigen::Matrix4d> closer = inverseOf(shifted)) {
        inverse_ = *closer;
        origin_ = origin;
    }
}

}  // namespace hashphase::detail
