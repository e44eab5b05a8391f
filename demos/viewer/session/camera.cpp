// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/camera.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kFieldOfView = 0.9F;  // vertical
constexpr float kPi = std::numbers::pi_v<float>;

constexpr Camera::Limits kPlace{-1e7F, 1e7F};        // [m]
constexpr Camera::Limits kDistance{0.015625, 1e7F};  // [m]
constexpr Camera::Limits kHeading{-kPi, kPi};
constexpr Camera::Limits kPitch{-1.55F, 1.55F};  // less than straight up or down

// As in Camera::state().
constexpr std::array<Camera::Limits, Camera::kStateSize> kLimits{
    kPlace,   kPlace, kPlace, kDistance, kHeading, kPlace,    kPlace,   kPlace,
    kHeading, kPitch, kPlace, kPlace,    kPlace,   kDistance, kHeading, kPitch};
constexpr std::array<std::size_t, 3> kHeadings{4, 8, 14};

Camera::State limited(Camera::State state) {
    for (const std::size_t heading : kHeadings) {
        state[heading] = std::remainder(state[heading], 2 * kPi);
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
        const auto [low, high] = kLimits[i];
        state[i] = state[i] >= low ? std::min(state[i], high) : low;  // NaN as well
    }
    return state;
}

Vector3<float> direction(float yaw, float pitch) {
    return {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

}  // namespace

void Camera::goHome(const Aabb<float>& bounds) {
    bounds_ = bounds;
    centre_ = bounds.center();
    const Vector3<float> sizes = bounds.sizes();
    const float extent = std::max(sizes.x(), sizes.z());
    height_ = 0.53F * extent / std::tan(kFieldOfView / 2);
    topYaw_ = 0;
    yaw_ = 0;
    const bool isFlat = sizes.y() < extent / 8;
    if (isFlat) {  // over the edge, so that near ones are large
        pitch_ = -0.42F;
        eye_ = {centre_.x(), bounds.max().y() + 0.14F * extent, bounds.max().z() + 0.08F * extent};
    } else {
        pitch_ = -0.3F;
        eye_ = centre_ - sizes.norm() * direction(yaw_, pitch_);
    }
    target_ = centre_;
    distance_ = std::max(12.0F, 0.04F * extent);
    followYaw_ = 0;
    followPitch_ = -0.4F;
    keepWithinLimits();
}

void Camera::setMode(CameraMode mode) {
    mode_ = mode;
}

void Camera::move(const Vector3<float>& way) {
    if (mode_ == CameraMode::top) {
        const Vector3<float> forward = direction(topYaw_, 0);
        centre_ += way.x() * forward.cross(Vector3<float>::UnitY()) + way.z() * forward;
        height_ = std::max(2.0F, height_ + way.y());
    } else if (mode_ == CameraMode::free) {
        const Vector3<float> forward = direction(yaw_, pitch_);
        eye_ += way.x() * direction(yaw_, 0).cross(Vector3<float>::UnitY()) +
                way.y() * Vector3<float>::UnitY() + way.z() * forward;
    }
    keepWithinLimits();
}

void Camera::turn(float yaw, float pitch) {
    switch (mode_) {
        case CameraMode::top:
            topYaw_ += yaw;
            break;
        case CameraMode::free:
            yaw_ += yaw;
            pitch_ += pitch;
            break;
        case CameraMode::follow:
            followYaw_ += yaw;
            followPitch_ += pitch;
            break;
    }
    keepWithinLimits();
}

void Camera::zoom(float factor) {
    switch (mode_) {
        case CameraMode::top:
            height_ = std::max(2.0F, height_ / factor);
            break;
        case CameraMode::free:
            eye_ += direction(yaw_, pitch_) * (reach() / 10 * (1 - 1 / factor));
            break;
        case CameraMode::follow:
            distance_ = std::max(2.0F, distance_ / factor);
            break;
    }
    keepWithinLimits();
}

void Camera::place(const Vector3<float>& eye, float yaw, float pitch) {
    mode_ = CameraMode::free;
    eye_ = eye;
    yaw_ = yaw;
    pitch_ = pitch;
    keepWithinLimits();
}

void Camera::setTarget(const Vector3<float>& target) {
    target_ = target;
    keepWithinLimits();
}

float Camera::reach() const {
    return bounds_.sizes().norm();
}

CameraPose Camera::pose(double aspect) const {
    CameraPose pose;
    pose.fieldOfView = kFieldOfView;
    pose.aspect = aspect;
    switch (mode_) {
        case CameraMode::top:
            pose.eye = centre_ + height_ * Vector3<float>::UnitY();
            pose.yaw = topYaw_;
            pose.pitch = -kPi / 2;
            break;
        case CameraMode::free:
            pose.eye = eye_;
            pose.yaw = yaw_;
            pose.pitch = pitch_;
            break;
        case CameraMode::follow:
            pose.eye = target_ - distance_ * direction(followYaw_, followPitch_);
            pose.yaw = followYaw_;
            pose.pitch = followPitch_;
            break;
    }
    pose.farPlane = 1.5F * reach() + (pose.eye - bounds_.center()).norm();
    return pose;
}

Camera::State Camera::state() const {
    return {centre_.x(), centre_.y(), centre_.z(), height_,     topYaw_,     eye_.x(),
            eye_.y(),    eye_.z(),    yaw_,        pitch_,      target_.x(), target_.y(),
            target_.z(), distance_,   followYaw_,  followPitch_};
}

std::span<const Camera::Limits, Camera::kStateSize> Camera::stateLimits() {
    return kLimits;
}

void Camera::setState(CameraMode mode, const State& wanted) {
    const State state = limited(wanted);
    mode_ = mode;
    centre_ = {state[0], state[1], state[2]};
    height_ = state[3];
    topYaw_ = state[4];
    eye_ = {state[5], state[6], state[7]};
    yaw_ = state[8];
    pitch_ = state[9];
    target_ = {state[10], state[11], state[12]};
    distance_ = state[13];
    followYaw_ = state[14];
    followPitch_ = state[15];
}

}  // namespace hashphase::demos
