// SPDX-License-Identifier: Zlib
#include <demos/scenes/paper_scene.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kFrame = 1.0F / 60;   // [s]
constexpr float kSlowest = 5;         // [m/s]
constexpr float kFastest = 15;        // [m/s]
constexpr float kLargestTurn = 0.1F;  // [rad] a frame
constexpr float kNearBorder = PaperScene::kRadius;
constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

PaperScene::PaperScene(std::size_t objects, std::uint64_t seed, float side)
    : side_(side), terrain_(seed), random_(seed) {
    const float farBorder = side_ - kRadius;
    walkers_.reserve(objects);
    boxes_.reserve(objects);
    for (std::size_t i = 0; i < objects; ++i) {
        Walker walker{};
        walker.x = random_.between(kNearBorder, farBorder);
        walker.z = random_.between(kNearBorder, farBorder);
        walker.heading = random_.between(-kPi, kPi);
        walker.stride = kFrame * random_.between(kSlowest, kFastest);
        walkers_.push_back(walker);
        boxes_.push_back(boxOf(walker));
    }
}

void PaperScene::advance() {
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
        walk(walkers_[i]);
        boxes_[i] = boxOf(walkers_[i]);
    }
}

Aabb<float> PaperScene::bounds() const {
    return {Vector3<float>(0, 0, 0), Vector3<float>(side_, Terrain::kHighest + 2 * kRadius, side_)};
}

GroundHeight PaperScene::ground() const {
    return [terrain = terrain_](float x, float z) { return terrain.height(x, z); };
}

void PaperScene::walk(Walker& walker) {
    const float farBorder = side_ - kRadius;
    walker.heading += random_.between(-kLargestTurn, kLargestTurn);
    walker.x += walker.stride * std::cos(walker.heading);
    walker.z += walker.stride * std::sin(walker.heading);
    if (walker.x < kNearBorder || walker.x > farBorder) {
        walker.x = std::clamp(walker.x, kNearBorder, farBorder);
        walker.heading = kPi - walker.heading;
    }
    if (walker.z < kNearBorder || walker.z > farBorder) {
        walker.z = std::clamp(walker.z, kNearBorder, farBorder);
        walker.heading = -walker.heading;
    }
    walker.heading = std::remainder(walker.heading, 2 * kPi);
}

Aabb<float> PaperScene::boxOf(const Walker& walker) const {
    const Vector3<float> centre(walker.x, terrain_.height(walker.x, walker.z) + kRadius, walker.z);
    const Vector3<float> radius = Vector3<float>::Constant(kRadius);
    return {centre - radius, centre + radius};
}

}  // namespace hashphase::demos
