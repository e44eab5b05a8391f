// SPDX-License-Identifier: Zlib
#pragma once

// A camera of a game, as those see it who cull.

#include <integration/camera/frustum.hpp>

#include <array>

namespace hashphase::demos {

inline constexpr float kNearPlane = 0.5F;  // [m]
inline constexpr float kFarPlane = 400;    // [m]
inline constexpr DepthRange kDepthRange = DepthRange::zeroToOne;

/// Where a camera stands and where it looks.
struct CameraPose {
    Vector3<float> eye = Vector3<float>::Zero();
    float yaw = 0;          // around the y axis, which is up; 0 looks along -z [rad]
    float pitch = 0;        // -pi / 2 looks straight down [rad]
    float fieldOfView = 1;  // vertical [rad]
    float farPlane = kFarPlane;
    double aspect = 16.0 / 9;  // of the screen: width by height
};

/// What is seen: the same as a matrix and as planes that face inwards.
struct CameraView {
    Eigen::Matrix4f viewProjection;
    std::array<Eigen::Hyperplane<float, 3>, 6> planes;
};

[[nodiscard]] CameraView cameraView(const CameraPose& pose);

}  // namespace hashphase::demos
