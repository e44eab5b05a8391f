// SPDX-License-Identifier: Zlib
#pragma once

// Boxes in Brownian motion: each moves by a random step in every frame, within a room of its own.
// The scenes differ only in how the boxes are scattered.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/random.hpp>

namespace hashphase::demos {

/// Where the boxes begin, how they move, and who pairs with whom.
struct BrownianBoxes {
    struct Body {
        Vector3<float> centre;
        Vector3<float> halfEdges;
        float step;  // largest move on an axis in a frame [m]; 0 rests for ever
        Aabb<float> roomForCentre;
    };
    std::vector<Body> bodies;
    std::vector<CollisionFilter> filters;  // empty: the default one for every box
};

class BrownianScene : public BoxScene {
public:
    BrownianScene(BrownianBoxes boxes, std::uint64_t seed);

    void advance() override;
    [[nodiscard]] Aabb<float> bounds() const override { return bounds_; }

private:
    std::vector<BrownianBoxes::Body> bodies_;
    Random random_;
    Aabb<float> bounds_;
};

/// Of the boxes that rest, each `period`-th becomes static: it pairs with those only that are not.
[[nodiscard]] BrownianBoxes withStatics(BrownianBoxes boxes, std::size_t period);

/// Edges of 0.5-1.5 m in a cube just so large that a box overlaps about two others.
[[nodiscard]] BrownianBoxes uniformBoxes(std::size_t objects, std::uint64_t seed);

/// Piles of 100 boxes of 0.5-1.5 m, each overlapping about five others; the piles are far apart.
[[nodiscard]] BrownianBoxes pileBoxes(std::size_t objects, std::uint64_t seed);

/// Cubes with log-uniform edges of 0.1-30 m, each overlapping about four others.
[[nodiscard]] BrownianBoxes logSizeBoxes(std::size_t objects, std::uint64_t seed);

/// Scattered like uniformBoxes; each `period`-th moves, the others stand still.
[[nodiscard]] BrownianBoxes someMovingBoxes(std::size_t objects, std::uint64_t seed,
                                            std::size_t period);

/// Scattered like uniformBoxes; every tenth moves, the others are static and pair with those only.
[[nodiscard]] BrownianBoxes mostlyStaticBoxes(std::size_t objects, std::uint64_t seed);

/// The Brownian scene of Serpa and Rodrigues, "Broadmark: A Testing Framework for Broad-Phase
/// Collision Detection Algorithms" (2020): unit cubes that fill a tenth of their room and move by up
/// to 2 m a frame.
[[nodiscard]] BrownianBoxes broadmarkBoxes(std::size_t objects, std::uint64_t seed);

/// Scattered like uniformBoxes; every 50th moves, the others rest and half of those are static.
[[nodiscard]] BrownianBoxes restingBoxes(std::size_t objects, std::uint64_t seed);

}  // namespace hashphase::demos
