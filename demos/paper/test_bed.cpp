// SPDX-License-Identifier: Zlib
#include <demos/paper/test_bed.hpp>

#include <broadphase/position_region.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

constexpr float kFramesPerSecond = 60;
constexpr float kEyeHeight = 45;  // [m]
constexpr float kPitch = -0.3F;   // [rad]
constexpr float kTurn = 0.01F;    // [rad] a frame
constexpr float kQuadEdge = 10;   // of the ground [m]

TriangleGround groundOf(const Terrain& terrain, float side) {
    return {static_cast<std::uint32_t>(std::ceil(side / kQuadEdge)),
            [&terrain](std::uint32_t i, std::uint32_t k) -> Vector3<float> {
                const float x = kQuadEdge * static_cast<float>(i);
                const float z = kQuadEdge * static_cast<float>(k);
                return {x, terrain.height(x, z), z};
            }};
}

/// The side of the domain of so many objects [m].
float sideFor(std::uint32_t objects) {
    constexpr float kMostInDomain = 50'000;  // of the paper's size
    return PaperScene::kSide *
           std::sqrt(std::max(static_cast<float>(objects) / kMostInDomain, 1.0F));
}

}  // namespace

TestBed::TestBed(std::uint32_t objects, std::uint64_t seed)
    : side_(sideFor(objects)),
      scene_(objects, seed, side_),
      ground_(groundOf(Terrain(seed), side_)),
      centres_(objects),
      velocities_(objects),
      colours_(objects) {
    Random random(seed + 1);
    for (std::uint32_t& colour : colours_) {
        colour = static_cast<std::uint32_t>(random.between(0, kColours)) % kColours;
    }
    for (std::size_t i = 0; i < objects; ++i) {
        centres_[i] = positionOf(boxes()[i]);
    }
    advance();
}

void TestBed::advance() {
    scene_.advance();
    for (std::size_t i = 0; i < centres_.size(); ++i) {
        const Vector3<float> centre = positionOf(boxes()[i]);
        velocities_[i] = kFramesPerSecond * (centre - centres_[i]);
        centres_[i] = centre;
    }
    ++frame_;
    CameraPose pose;
    pose.eye = {side_ / 2, kEyeHeight, side_ / 2};
    pose.yaw = kTurn * static_cast<float>(frame_);
    pose.pitch = kPitch;
    view_ = cameraView(pose);
}

}  // namespace hashphase::demos
