// SPDX-License-Identifier: Zlib
#pragma once

// P9, its parts.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/terrain/ground_methods.hpp>

namespace hashphase::demos {

/// How much is measured.
struct TerrainPlan {
    std::size_t spheres;  // on each ground
    std::size_t points;   // of each place
    int frames;           // that are timed
    std::size_t spheresPerFrame;
};

/// Measures, and says what it shows (terrain.sql).
[[nodiscard]] Findings findTerrain(const TerrainPlan& plan, std::uint64_t seed,
                                   std::span<const GroundMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
