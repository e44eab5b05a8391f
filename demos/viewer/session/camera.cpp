// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/camera.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kFieldOfView = 0.9F;  // vertical
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kNearest = 2;  // that steering comes to what is looked at [m]

constexpr Camera::Limits kPlace{-1e7F, 1e7F};        // [m]
constexpr Camera::Limits kDistance{0.015625, 1e7F};  // [m]
constexpr Camera::Limits kHeading{-kPi, kPi};
constexpr Camera::Limits kPitch{-1.55F, 1.55F};  // less than straight up or down

// As in Camera::numbers().
constexpr std::array<Camera::Limits, Camera::kStateSize> kLimits{
    kPlace,   kPlace, kPlace, kDistance, kHeading, kPlace,    kPlace,   kPlace,
    kHeading, kPitch, kPlace, kPlace,    kPlace,   kDistance, kHeading, kPitch};
constexpr std::array<std::size_t, 3> kHeadings{4, 8, 14};

Vector3<float> direction(float yaw, float pitch) {
    return {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

Vector3<float> rightward(float yaw) {
    return direction(yaw, 0).cross(Vector3<float>::UnitY());
}

}  // namespace

void Camera::goHome(const Aabb<float>& bounds) {
    bounds_ = bounds;
    auto& [top, free, follow] = stands_;
    const Vector3<float> sizes = bounds.sizes();
    const float extent = std::max(sizes.x(), sizes.z());
    top = {bounds.center(), 0.53F * extent / std::tan(kFieldOfView / 2), 0, 0};
    if (sizes.y() < extent / 8) {  // flat: over the edge, so that near ones are large
        free.pitch = -0.42F;
        free.at = {top.at.x(), bounds.max().y() + 0.14F * extent,
                   bounds.max().z() + 0.08F * extent};
    } else {
        free.pitch = -0.3F;
        free.at = top.at - sizes.norm() * direction(0, free.pitch);
    }
    free.yaw = 0;
    follow = {top.at, std::max(12.0F, 0.04F * extent), 0, -0.4F};
    keepWithinLimits();
}

void Camera::move(const Vector3<float>& way) {
    Stand& now = stand();
    if (mode_ == CameraMode::top) {
        now.at += way.x() * rightward(now.yaw) + way.z() * direction(now.yaw, 0);
        now.distance = std::max(kNearest, now.distance + way.y());
    } else if (mode_ == CameraMode::free) {
        now.at += way.x() * rightward(now.yaw) + way.y() * Vector3<float>::UnitY() +
                  way.z() * direction(now.yaw, now.pitch);
    }
    keepWithinLimits();
}

void Camera::turn(float yaw, float pitch) {
    stand().yaw += yaw;
    stand().pitch += pitch;
    keepWithinLimits();
}

void Camera::zoom(float factor) {
    Stand& now = stand();
    if (mode_ == CameraMode::free) {
        now.at += direction(now.yaw, now.pitch) * (bounds_.sizes().norm() / 10 * (1 - 1 / factor));
    } else {
        now.distance = std::max(kNearest, now.distance / factor);
    }
    keepWithinLimits();
}

void Camera::place(const Vector3<float>& eye, float yaw, float pitch) {
    mode_ = CameraMode::free;
    stand() = {eye, 0, yaw, pitch};
    keepWithinLimits();
}

void Camera::setTarget(const Vector3<float>& target) {
    stands_.back().at = target;
    keepWithinLimits();
}

CameraPose Camera::pose(double aspect) const {
    const Stand& now = stands_[static_cast<std::size_t>(mode_)];
    CameraPose pose;
    pose.fieldOfView = kFieldOfView;
    pose.aspect = aspect;
    pose.yaw = now.yaw;
    pose.pitch = mode_ == CameraMode::top ? -kPi / 2 : now.pitch;
    pose.eye = now.at;
    if (mode_ == CameraMode::top) {
        pose.eye += now.distance * Vector3<float>::UnitY();
    } else if (mode_ == CameraMode::follow) {
        pose.eye -= now.distance * direction(now.yaw, now.pitch);
    }
    pose.farPlane = 1.5F * bounds_.sizes().norm() + (pose.eye - bounds_.center()).norm();
    return pose;
}

// --- State ---------------------------------------------------------------------------------------

std::array<float*, Camera::kStateSize> Camera::numbers() {
    auto& [top, free, follow] = stands_;
    return {&top.at.x(),    &top.at.y(),      &top.at.z(),    &top.distance,
            &top.yaw,       &free.at.x(),     &free.at.y(),   &free.at.z(),
            &free.yaw,      &free.pitch,      &follow.at.x(), &follow.at.y(),
            &follow.at.z(), &follow.distance, &follow.yaw,    &follow.pitch};
}

Camera::State Camera::state() const {
    Camera copy = *this;
    State state{};
    std::ranges::transform(copy.numbers(), state.begin(),
                           [](const float* number) { return *number; });
    return state;
}

std::span<const Camera::Limits, Camera::kStateSize> Camera::stateLimits() {
    return kLimits;
}

void Camera::setState(CameraMode mode, const State& wanted) {
    State state = wanted;
    for (const std::size_t heading : kHeadings) {
        state[heading] = std::remainder(state[heading], 2 * kPi);
    }
    mode_ = mode;
    const auto all = numbers();
    for (std::size_t i = 0; i < state.size(); ++i) {
        const auto [low, high] = kLimits[i];
        *all[i] = state[i] >= low ? std::min(state[i], high) : low;  // NaN as well
    }
}

}  // namespace hashphase::demos
