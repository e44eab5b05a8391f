// SPDX-License-Identifier: Zlib
#pragma once

// The test bed of Hastings, Mesit, Guha, "Optimization of Large-Scale, Real-Time Simulations by
// Spatial Hashing": spheres of radius 1 that roam a random terrain of 400 x 400.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/random.hpp>
#include <demos/scenes/terrain.hpp>

namespace hashphase::demos {

/// Each sphere touches the ground (its centre is one radius above the terrain), has a speed of its
/// own between 5 and 15 m/s, turns a little in every frame and bounces off the borders.
class PaperScene : public BoxScene {
public:
    /// On a square of `side` [m].
    PaperScene(std::size_t objects, std::uint64_t seed, float side = kSide);

    void advance() override;
    [[nodiscard]] Aabb<float> bounds() const override;
    [[nodiscard]] GroundHeight ground() const override;

    static constexpr float kSide = 400;  // of the paper's domain, which begins at (0, 0) [m]
    static constexpr float kRadius = 1;  // [m]

private:
    struct Walker {
        float x;
        float z;
        float heading;  // [rad]
        float stride;   // [m] a frame
    };

    void walk(Walker& walker);
    [[nodiscard]] Aabb<float> boxOf(const Walker& walker) const;

    float side_;
    Terrain terrain_;
    Random random_;
    std::vector<Walker> walkers_;
};

}  // namespace hashphase::demos
