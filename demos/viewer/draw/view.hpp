// SPDX-License-Identifier: Zlib
#pragma once

// What a camera's matrix says, taken apart.

#include <demos/viewer/draw/picture.hpp>

#include <limits>
#include <utility>

namespace hashphase::demos {

/// A perspective camera on a screen of `size` pixels.
struct View {
    View(const DrawnCamera& camera, Eigen::Vector2f sizeOfScreen)
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

    /// How far in front of the eye, along the axis of the camera [m]; negative behind it.
    [[nodiscard]] float depth(const Vector3<float>& point) const {
        return forward.dot(point - eye);
    }

    /// The radius on the screen of a sphere so far in front of the eye [pixels].
    [[nodiscard]] float pixels(float radius, float depthOfCentre) const {
        return focalLength * radius / depthOfCentre;
    }

    Eigen::Vector2f size;           // of the screen [pixels]
    Eigen::Matrix4f clipFromWorld;  // as OpenGL wants it: depth from -1 to 1
    Vector3<float> eye;
    Vector3<float> forward;    // of length one, as are the next two
    Vector3<float> up;         // upwards on the screen
    Vector3<float> right;      // rightwards
    Eigen::Vector2f tangents;  // of half the angles of view, horizontal and vertical
    float focalLength;         // what is so far away is as large in pixels as in metres
    float eyeDepth;            // depth of the eye before the division by w; negative
    float farPlane;            // [m]; may be infinite
};

}  // namespace hashphase::demos
