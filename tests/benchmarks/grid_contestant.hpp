// SPDX-License-Identifier: Zlib
#pragma once

// hashphase::Grid and hashphase::Pairs without Bullet: what a frame costs before any pair cache.

#include <broadphase/grid_config.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/sweep_mode.hpp>
#include <tests/benchmarks/contestant.hpp>

#include <optional>

namespace hashphase::benchmarks {

/// Its frame ends with the sorted births and deaths. The list that they add up to, which is what is
/// checked, is kept outside of the timing.
[[nodiscard]] ContestantKind gridKind(std::string name, const GridConfig& config);

/// The same with a hashphase::Sweeps, in which the objects in motion sweep as told; with Sweep::none
/// nobody does.
[[nodiscard]] ContestantKind sweepingGridKind(std::string name, Sweep sweep,
                                              ParallelFor parallelFor);

/// A grid that has the scene far away.
struct FarGrid {
    double distance = 0;   ///< of the scene's origin on each axis [m]
    double shift = 0;      ///< by which the origin is shifted in every frame, there and back [m]
    bool isDouble = true;  ///< else in single precision
};

/// gridKind() of a scene of which the boxes are exact there, see farBenchmarks().
[[nodiscard]] ContestantKind farGridKind(std::string name, const FarGrid& far);

}  // namespace hashphase::benchmarks
