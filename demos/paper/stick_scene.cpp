// SPDX-License-Identifier: Zlib
//
// Overlap of oriented boxes and distance of segments: C. Ericson, "Real-Time Collision Detection",
// 2005, sections 4.4.1 and 5.1.9.

#include <demos/paper/stick_scene.hpp>

#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr float kVolumeOfEach = 30;    // [m^3]
constexpr float kTurnOfFrame = 0.05F;  // [rad]
constexpr float kRounding = 1e-3F;     // [m]
constexpr float kReach = Stick::kHalfLength + Stick::kRadius + kRounding;
constexpr std::array kHalfExtents{kReach, Stick::kRadius + kRounding, Stick::kRadius + kRounding};

Vector3<float> randomDirection(Random& random) {
    Vector3<float> direction;
    do {
        direction = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    } while (direction.squaredNorm() > 1 || direction.squaredNorm() < 0.01F);
    return direction.normalized();
}

float halfAlong(const Stick& stick, const Vector3<float>& direction) {
    float half = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        half += kHalfExtents[i] * std::abs(stick.axes[i].dot(direction));
    }
    return half;
}

bool isBetween(const Stick& a, const Stick& b, const Vector3<float>& direction) {
    return std::abs((b.centre - a.centre).dot(direction)) >
           halfAlong(a, direction) + halfAlong(b, direction);
}

bool orientedBoxesOverlap(const Stick& a, const Stick& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (isBetween(a, b, a.axes[i]) || isBetween(a, b, b.axes[i])) {
            return false;
        }
    }
    for (const Vector3<float>& u : a.axes) {
        for (const Vector3<float>& v : b.axes) {
            // Parallel edges give no direction of their own.
            const Vector3<float> across = u.cross(v);
            if (across.squaredNorm() > 1e-6F && isBetween(a, b, across)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

StickScene::StickScene(std::uint32_t sticks, std::uint64_t seed) {
    Random random(seed);
    const float edge = std::cbrt(kVolumeOfEach * static_cast<float>(sticks));
    for (std::uint32_t i = 0; i < sticks; ++i) {
        Stick stick;
        stick.centre = {random.between(0, edge), random.between(0, edge), random.between(0, edge)};
        stick.axes[0] = randomDirection(random);
        stick.axes[1] = stick.axes[0].unitOrthogonal();
        stick.axes[2] = stick.axes[0].cross(stick.axes[1]);
        sticks_.push_back(stick);
        turns_.push_back(randomDirection(random));
    }
}

void StickScene::advance() {
    for (std::size_t i = 0; i < sticks_.size(); ++i) {
        const Eigen::AngleAxis<float> turn(kTurnOfFrame, turns_[i]);
        for (Vector3<float>& axis : sticks_[i].axes) {
            axis = turn * axis;
        }
    }
}

Aabb<float> boxOf(VolumeKind kind, const Stick& stick) {
    Vector3<float> half = Vector3<float>::Constant(kReach);
    if (kind == VolumeKind::aabb) {
        half = Stick::kHalfLength * stick.axes[0].cwiseAbs() +
               Vector3<float>::Constant(Stick::kRadius + kRounding);
    } else if (kind == VolumeKind::obb) {
        half = {halfAlong(stick, Vector3<float>::UnitX()),
                halfAlong(stick, Vector3<float>::UnitY()),
                halfAlong(stick, Vector3<float>::UnitZ())};
    }
    return {stick.centre - half, stick.centre + half};
}

bool volumesOverlap(VolumeKind kind, const Stick& a, const Stick& b) {
    switch (kind) {
        case VolumeKind::sphere:
            return (b.centre - a.centre).squaredNorm() <= 4 * kReach * kReach;
        case VolumeKind::aabb:
            return true;
        case VolumeKind::obb:
            return orientedBoxesOverlap(a, b);
    }
    return true;
}

bool sticksTouch(const Stick& a, const Stick& b) {
    const Vector3<float>& u = a.axes[0];
    const Vector3<float>& v = b.axes[0];
    const Vector3<float> between = a.centre - b.centre;
    const auto within = [](float along) {
        return std::clamp(along, -Stick::kHalfLength, Stick::kHalfLength);
    };
    const float cosine = u.dot(v);
    const float alongU = u.dot(between);
    const float alongV = v.dot(between);
    const float sineSquared = 1 - cosine * cosine;
    // The nearest point of the first line; then of the second segment to it, and back.
    float s = sineSquared > 1e-6F ? within((cosine * alongV - alongU) / sineSquared) : 0;
    const float t = within(cosine * s + alongV);
    s = within(cosine * t - alongU);
    constexpr float kTouching = 2 * Stick::kRadius;
    return (between + s * u - t * v).squaredNorm() <= kTouching * kTouching;
}

}  // namespace hashphase::demos
