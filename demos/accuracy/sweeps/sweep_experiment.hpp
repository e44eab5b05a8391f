// SPDX-License-Identifier: Zlib
#pragma once

// P1: what fast objects meet on their way, who sees it, and what seeing costs.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/sweeps/sweep_methods.hpp>

namespace hashphase::demos {

struct FastMotion {
    double cells = 0;      // a frame; of 1 m
    int judgedFrames = 0;  // the slower, the less is met in one
};

/// How much is measured.
struct SweepPlan {
    std::vector<double> thicknesses;  // of walls [m]
    std::vector<double> ratios;       // of the bullets' steps to wall and bullet
    int wallFrames = 0;               // of each wall and ratio
    int bodyRounds = 0;               // of kFlyingBodies in Bullet's world, at the same
    std::uint32_t objects = 0;
    std::uint32_t movers = 0;
    std::vector<FastMotion> motions;
    int timedFrames = 0;
};

/// Measures, and says what it shows (sweeps.sql).
[[nodiscard]] Findings findSweeps(const SweepPlan& plan, std::uint64_t seed,
                                  std::span<const SweepMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
