// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase::demos {

/// Who is in a scene of effects, where, and for how long: spheres on a square, and zones of interest.
/// Each range is in effects_fields.cpp.
struct EffectsScene {
    std::uint32_t objects = 1000;
    double radius = 1;          ///< of every body [m]
    double domain = 400;        ///< side of the square, which begins at (0, 0) [m]
    std::uint32_t terrain = 0;  ///< squares of ground along a side, of two triangles each; 0: none
    double speed = 10;          ///< of a body that moves, on average [m/s]
    double moving = 1;          ///< share of the bodies that move
    double fast = 0;            ///< share of the bodies that fly
    double fastSpeed = 300;     ///< of a body that flies [m/s]
    std::uint32_t seed = 1;
    std::uint32_t zones = 0;
    std::uint32_t frames = 120;
    double timeStep = 1.0 / 60;  ///< [s]
};

}  // namespace hashphase::demos
