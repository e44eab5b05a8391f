// SPDX-License-Identifier: Zlib
#pragma once

// The matrices of cameras of every kind, as graphics programs make them.

#include <integration/camera/frustum.hpp>

#include <cmath>

namespace hashphase::test {

struct CameraLens {
    double fieldOfView = 1;  // vertical [rad]; of an orthographic one, half of its height [m]
    double aspect = 1.6;
    double nearPlane = 0.1;  // [m]
    double farPlane = 100;   // [m]; infinity for none
    DepthRange depthRange = DepthRange::zeroToOne;
    bool isReversed = false;
    bool isOrthographic = false;
};

/// Eye space (looking along -z) to clip space.
[[nodiscard]] inline Eigen::Matrix4d projectionMatrix(const CameraLens& lens) {
    const double n = lens.nearPlane;
    const double f = lens.farPlane;
    // Depth as a / w-ish: clip z = slope * z + shift, which is `atNear` times w at the near plane and
    // `atFar` times w at the far one.
    const double least = lens.depthRange == DepthRange::zeroToOne ? 0 : -1;
    const double atNear = lens.isReversed ? 1 : least;
    const double atFar = lens.isReversed ? least : 1;
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    if (lens.isOrthographic) {
        matrix(0, 0) = 1 / (lens.fieldOfView * lens.aspect);
        matrix(1, 1) = 1 / lens.fieldOfView;
        matrix(2, 2) = -(atFar - atNear) / (f - n);
        matrix(2, 3) = atNear - n * (atFar - atNear) / (f - n);
        matrix(3, 3) = 1;
        return matrix;
    }
    const double scale = 1 / std::tan(lens.fieldOfView / 2);
    matrix(0, 0) = scale / lens.aspect;
    matrix(1, 1) = scale;
    // -n * slope + shift = atNear * n and -f * slope + shift = atFar * f.
    const double slope = std::isinf(f) ? -atFar : (atNear * n - atFar * f) / (f - n);
    matrix(2, 2) = slope;
    matrix(2, 3) = n * (atNear + slope);
    matrix(3, 2) = -1;
    return matrix;
}

/// World to eye space, for an eye at `eye` that looks at `target`, the y axis upwards.
[[nodiscard]] inline Eigen::Matrix4d viewMatrix(const Vector3<double>& eye,
                                                const Vector3<double>& target) {
    const Vector3<double> forward = (target - eye).normalized();
    const Vector3<double> up =
        std::abs(forward.y()) > 0.999 ? Vector3<double>::UnitZ() : Vector3<double>::UnitY();
    Eigen::Matrix3d rows;
    rows.row(0) = forward.cross(up).normalized().transpose();
    rows.row(2) = -forward.transpose();
    rows.row(1) = rows.row(2).cross(rows.row(0));
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = rows;
    matrix.topRightCorner<3, 1>() = -rows * eye;
    return matrix;
}

template <class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, 4, 4> cameraMatrix(const CameraLens& lens,
                                                       const Vector3<double>& eye,
                                                       const Vector3<double>& target) {
    return (projectionMatrix(lens) * viewMatrix(eye, target)).cast<Scalar>();
}

}  // namespace hashphase::test
