// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/unaligned.hpp>
#include <integration/camera/export.hpp>

namespace hashphase::detail {

/// The way from the screen back into the world, in double precision.
class HASHPHASE_CAMERA_EXPORT CameraInverse {
public:
    CameraInverse() = default;

    /// Of a view-projection matrix, 4 x 4.
    explicit CameraInverse(const Matrix4<double>& viewProjection);

    /// False for a matrix that is singular or not finite.
    [[nodiscard]] bool isValid() const noexcept { return isValid_; }

    /// The world's homogeneous point with these normalised device coordinates. Its weight, w, is one
    /// by the w of clip space: positive in front of the eye, the smaller the farther away, 0 at
    /// infinity. Points of a segment in device coordinates are those between its homogeneous ends.
    [[nodiscard]] Vector4<double> at(double x, double y, double z) const {
        Vector4<double> point = inverse_ * Vector4<double>(x, y, z, 1);
        point.head<3>() += point.w() * origin_;
        return point;
    }

    /// The weight of points that lie `farther` [m] behind those of weight `nearer`, as seen from the
    /// eye; a little less, for rounding. 0 when all have the same weight (orthographic).
    [[nodiscard]] double weightBehind(double nearer, double farther) const noexcept {
        return weightPerMetre_ == 0 ? 0 : (1 - 1e-12) / (1 / nearer + farther * weightPerMetre_);
    }

private:
    // Of the matrix for a world with its origin near the eye. For one far away, what a weight loses by
    // cancellation would move points by as large a share of the way from there.
    Matrix4<double> inverse_ = Matrix4<double>::Zero();
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // [m]
    double weightPerMetre_ = 0;                         // of the w of clip space, along the view
    bool isValid_ = false;
};

}  // namespace hashphase::detail
