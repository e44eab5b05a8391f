// SPDX-License-Identifier: Zlib
#pragma once

// hashphase::Grid and hashphase::Pairs without Bullet: what a frame costs before any pair cache.

#include <broadphase/grid_config.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/sweep_mode.hpp>
#include <tests/benchmarks/contestant.hpp>

#include <optional>

namespace hashphase::benchmarks {

struct GridPlan {
    GridConfig config = {};
    ParallelFor parallelFor = serialFor;

    /// With a hashphase::Sweeps, in which the objects in motion sweep so; with Sweep::none nobody does.
    std::optional<Sweep> sweep = std::nullopt;

    // Far away, for scenes of which the boxes are exact there.
    std::optional<double> distance = std::nullopt;  // of the scene's origin on each axis [m]
    double shift = 0;  // by which the origin is shifted in every frame, there and back [m]
    bool isDouble = false;
};

/// Its frame ends with the sorted births and deaths. The list that they add up to, which is what is
/// checked, is kept outside of the timing.
[[nodiscard]] ContestantKind gridKind(std::string name, const GridPlan& plan = {});

}  // namespace hashphase::benchmarks
