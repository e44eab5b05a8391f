// SPDX-License-Identifier: Zlib
#pragma once

// What a camera's matrix says, taken apart.

#include <demos/viewer/draw/picture.hpp>

namespace hashphase::demos {

/// A perspective camera on a screen of `size` pixels.
struct View {
    View(const DrawnCamera& camera, Eigen::Vector2f size);

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
