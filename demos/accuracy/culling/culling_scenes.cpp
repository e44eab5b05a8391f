// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_scenes.hpp>

#include <Eigen/LU>

#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kSide = 1000;      // of the ground [m]
constexpr float kEyeHeight = 120;  // [m]
constexpr float kDegree = std::numbers::pi_v<float> / 180;

// In a 60th of a second, at 6 m/s and 12 degrees a second.
constexpr float kStride = 0.1F;          // [m]
constexpr float kTurn = 0.2F * kDegree;  // [rad]

// A random point of the left, right, bottom or top plane, between the near plane and the far one.
Vector3<double> pointOnSide(const Eigen::Matrix4d& toWorld, std::size_t plane, Random& random) {
    Eigen::Vector4d onScreen(static_cast<double>(random.between(-1, 1)),
                             static_cast<double>(random.between(-1, 1)),
                             1 - static_cast<double>(random.between(0, 0.01F)), 1);
    onScreen[static_cast<Eigen::Index>(plane / 2)] = plane % 2 == 0 ? -1 : 1;
    return (toWorld * onScreen).eval().hnormalized();
}

}  // namespace

std::vector<CameraView> flight(const CullingSetting& setting, Random& random) {
    CameraPose pose;
    pose.eye = {random.between(0.3F, 0.7F) * kSide, kEyeHeight, random.between(0.3F, 0.7F) * kSide};
    pose.yaw = setting.yaw * kDegree;
    pose.pitch = setting.pitch * kDegree;
    pose.fieldOfView = setting.fieldOfView * kDegree;
    std::vector<CameraView> views;
    for (int i = 0; i < kViewsPerFlight; ++i) {
        views.push_back(cameraView(pose));
        pose.eye.x() += kStride;
        pose.yaw += kTurn;
    }
    return views;
}

std::vector<Aabb<float>> standingBoxes(std::size_t count, float tallest, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb<float>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<float> low{random.between(0, kSide), 0, random.between(0, kSide)};
        const Vector3<float> size{random.between(1, 3), tallest * random.between(0.1F, 1),
                                  random.between(1, 3)};
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

std::vector<Aabb<float>> touchingBoxes(std::size_t count, float tallest, const CameraView& view,
                                       Random& random) {
    const Eigen::Matrix4d toWorld = view.viewProjection.cast<double>().inverse();
    std::vector<Aabb<float>> boxes;
    while (boxes.size() < count) {
        const auto plane = static_cast<std::size_t>(random.between(0, 4));
        const Vector3<float> corner = pointOnSide(toWorld, plane, random).cast<float>();
        const Vector3<float> size{random.between(1, 3), random.between(1, 3), random.between(1, 3)};
        // The normal points inwards, and so does the corner.
        const Vector3<float> normal = view.planes[plane].normal();
        const Vector3<float> opposite = (normal.array() > 0).select(corner - size, corner + size);
        const Aabb<float> box(corner.cwiseMin(opposite), corner.cwiseMax(opposite));
        if (box.min().y() >= 0 && box.max().y() <= tallest) {
            boxes.push_back(box);
        }
    }
    return boxes;
}

}  // namespace hashphase::demos
