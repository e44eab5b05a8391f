// SPDX-License-Identifier: Zlib
#pragma once

// The boxes on which Pierre Terdiman's "Box pruning revisited" (2017) measures: integer
// coordinates, extents of 0-254 in a cube of 4,096, drawn with Microsoft's rand().

#include <demos/scenes/box_scene.hpp>

namespace hashphase::demos {

/// Seed 1 begins as the published scene: exactly 11,811 pairs with 10,000 boxes and 1,144,045 with
/// 100,000. That one stands still; here every box drifts by up to 4 units an axis and frame.
class TerdimanScene : public BoxScene {
public:
    TerdimanScene(std::size_t objects, std::uint64_t seed);

    void advance() override;
    [[nodiscard]] Aabb<float> bounds() const override;

private:
    /// Microsoft's rand(): 15 bits.
    int draw() noexcept {
        state_ = state_ * 214013U + 2531011U;
        return static_cast<int>(state_ >> 16 & 0x7fff);
    }

    std::uint32_t state_;
    std::vector<Vector3<float>> centres_;
    std::vector<Vector3<float>> halfExtents_;
};

}  // namespace hashphase::demos
