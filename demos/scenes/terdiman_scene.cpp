// SPDX-License-Identifier: Zlib
#include <demos/scenes/terdiman_scene.hpp>

namespace hashphase::demos {
namespace {

constexpr float kHalfSide = 2048;
constexpr float kLargestHalfExtent = 127;
constexpr int kDrift = 4;  // [units] on an axis in a frame

// The published scene is drawn with 42; ours counts from 1.
constexpr std::uint32_t kSeedBeforeTheFirst = 41;

}  // namespace

TerdimanScene::TerdimanScene(std::size_t objects, std::uint64_t seed)
    : state_(kSeedBeforeTheFirst + static_cast<std::uint32_t>(seed)) {
    for (std::size_t i = 0; i < objects; ++i) {
        Vector3<float> centre;
        Vector3<float> halfExtents;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            centre[axis] = static_cast<float>(draw() & 4095) - kHalfSide;
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            halfExtents[axis] = static_cast<float>(draw() & 127);
        }
        centres_.push_back(centre);
        halfExtents_.push_back(halfExtents);
        boxes_.emplace_back(centre - halfExtents, centre + halfExtents);
    }
}

void TerdimanScene::advance() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        Vector3<float>& centre = centres_[i];
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            centre[axis] += static_cast<float>(draw() % (2 * kDrift + 1) - kDrift);
        }
        centre = centre.cwiseMax(-kHalfSide).cwiseMin(kHalfSide);
        boxes_[i] = {centre - halfExtents_[i], centre + halfExtents_[i]};
    }
}

Aabb<float> TerdimanScene::bounds() const {
    const Vector3<float> corner = Vector3<float>::Constant(kHalfSide + kLargestHalfExtent);
    return {-corner, corner};
}

}  // namespace hashphase::demos
