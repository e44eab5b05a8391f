// SPDX-License-Identifier: Zlib
#pragma once

// Agents that wander over a square or through a cube, at places where single precision tells who is
// within up to 16 m without rounding: coordinates are multiples of 1/256 m.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/random.hpp>

#include <array>

namespace hashphase::demos {

struct AgentPlan {
    std::size_t agents = 0;
    double side = 0;    // of the square or cube [m]; at most 60 km
    double edge = 0.5;  // of an agent's box [m], a multiple of 1/128
    double step = 0;    // largest move on an axis in a frame [m]
    bool isFlat = true;
};

class AgentScene : public BoxScene {
public:
    AgentScene(const AgentPlan& plan, std::uint64_t seed);

    void advance() override { moveBy(-step_, step_); }
    [[nodiscard]] Aabb<float> bounds() const override;

private:
    using Place = std::array<std::int32_t, 3>;  // [m / 256]

    /// Each agent by a random way from low to high along each axis, and sets the boxes.
    void moveBy(std::int32_t low, std::int32_t high);

    Random random_;
    bool isFlat_;
    std::int32_t side_;
    std::int32_t step_;
    float halfEdge_;
    std::vector<Place> places_;  // of centres
};

}  // namespace hashphase::demos
