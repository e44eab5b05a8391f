// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that stay near where they are, as bodies in piles and stacks do before they sleep: they tremble
// about a place, creep away from it, or breathe (grow and shrink). Some travel through them.

#include <demos/scenes/brownian_scene.hpp>

namespace hashphase::demos {

/// How the boxes of a scene move; lengths in metres.
struct NearMotion {
    float tremble = 0;  // largest distance from the place, an axis
    float creep = 0;    // the place's move in a frame; each box has a direction of its own
    float breathe = 0;  // largest change of a half edge
    std::size_t travellers =
        0;  // each so-manieth box travels instead, as in uniformBoxes(); 0: none
};

class NearScene : public BoxScene {
public:
    /// Scattered like uniformBoxes().
    NearScene(std::size_t objects, std::uint64_t seed, const NearMotion& motion);

    void advance() override;
    [[nodiscard]] Aabb<float> bounds() const override;

private:
    void place(std::size_t object);

    std::vector<BrownianBoxes::Body> bodies_;
    std::vector<Vector3<float>> creep_;  // by object
    NearMotion motion_;
    Random random_;
};

}  // namespace hashphase::demos
