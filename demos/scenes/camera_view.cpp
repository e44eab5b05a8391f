// SPDX-License-Identifier: Zlib
#include <demos/scenes/camera_view.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

// Eye space looks along -z; its depths become 0 at the near plane and 1 at the far one.
Eigen::Matrix4d projection(double fieldOfView, double farPlane, double aspect) {
    const double scale = 1 / std::tan(fieldOfView / 2);
    const double slope = farPlane / (double{kNearPlane} - farPlane);
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    matrix(0, 0) = scale / aspect;
    matrix(1, 1) = scale;
    matrix(2, 2) = slope;
    matrix(2, 3) = slope * kNearPlane;
    matrix(3, 2) = -1;
    return matrix;
}

}  // namespace

CameraView cameraView(const CameraPose& pose) {
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(pose.yaw, Vector3<double>::UnitY()) *
                                  Eigen::AngleAxisd(pose.pitch, Vector3<double>::UnitX()))
                                     .toRotationMatrix();
    Eigen::Matrix4d toEye = Eigen::Matrix4d::Identity();
    toEye.topLeftCorner<3, 3>() = turn.transpose();
    toEye.topRightCorner<3, 1>() = -turn.transpose() * pose.eye.cast<double>();
    CameraView view;
    view.viewProjection =
        (projection(pose.fieldOfView, pose.farPlane, pose.aspect) * toEye).cast<float>();
    view.planes = frustumPlanes<float>(view.viewProjection, kDepthRange);
    return view;
}

}  // namespace hashphase::demos
