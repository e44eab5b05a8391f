// SPDX-License-Identifier: Zlib
#pragma once

// What is wrong in a scene, found by looking at all of it: what effects are there to prevent.

#include <demos/effects/effects_world.hpp>

namespace hashphase::demos {

class EffectsProbe {
public:
    explicit EffectsProbe(const EffectsScene& scene);

    /// Pairs of spheres that reach into each other by more than a twentieth of a radius.
    [[nodiscard]] std::size_t interpenetrating(const EffectsWorld& world) const;

    /// Bodies that walk, and whose height is wrong by more than a centimetre.
    [[nodiscard]] std::size_t offGround(const EffectsWorld& world) const;

private:
    EffectsScene scene_;
    Grid<float> grid_;
    hashphase::Terrain<float> ground_;
};

}  // namespace hashphase::demos
