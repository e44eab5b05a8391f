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

}  // namespace hashphase::benchmarks
