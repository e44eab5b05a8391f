// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/view.hpp>

namespace hashphase::demos {

View::View(const DrawnCamera& camera, Eigen::Vector2f sizeOfScreen)
    : size(std::move(sizeOfScreen)), clipFromWorld(camera.viewProjection), eye(camera.eye) {
    const Eigen::Matrix4f& matrix = camera.viewProjection;
    clipFromWorld.row(2) = 2 * matrix.row(2) - matrix.row(3);

    const Vector3<float> x = matrix.row(0).head<3>();
    const Vector3<float> y = matrix.row(1).head<3>();
    const Vector3<float> w = matrix.row(3).head<3>();
    right = x.normalized();
    up = y.normalized();
    forward = w.normalized();
    tangents = {w.norm() / x.norm(), w.norm() / y.norm()};
    focalLength = size.y() / 2 / tangents.y();

    // The depth of what is z metres in front of the eye is growth * z + eyeDepth, over z.
    const float growth = matrix.row(2).head<3>().dot(forward) / w.norm();
    eyeDepth = (matrix.row(2).head<3>().dot(eye) + matrix(2, 3)) / w.norm();
    farPlane = growth > 1 ? -eyeDepth / (growth - 1) : std::numeric_limits<float>::infinity();
}

}  // namespace hashphase::demos
