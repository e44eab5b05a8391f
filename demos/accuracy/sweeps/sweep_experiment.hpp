// SPDX-License-Identifier: Zlib
#pragma once

// P1: what fast objects meet on their way, who sees it, and what seeing costs.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/sweeps/fast_movers.hpp>
#include <demos/accuracy/sweeps/flying_bodies.hpp>
#include <demos/accuracy/sweeps/tunnelling.hpp>

namespace hashphase::demos {

struct SweepPlan {
    TunnellingPlan tunnelling;
    int bodyRounds = 0;  // of bodies in Bullet's world, at the same walls and ratios
    FastMoversPlan movers;
};

[[nodiscard]] SweepPlan sweepPlan(const Effort& effort);

struct SweepResults {
    const SweepPlan& plan;
    std::span<const SweepMethod> methods;
    std::uint64_t seed = 0;
    std::vector<TunnellingPoint> points;
    std::vector<FlyingBodiesPoint> bodies;
    std::vector<MotionResult> motions;
};

/// The experiment, with these methods.
[[nodiscard]] Findings measureSweeps(const SweepPlan& plan, std::span<const SweepMethod> methods,
                                     std::uint64_t seed, const TellProgress& tell);

/// Its parts.
[[nodiscard]] std::vector<Chart> sweepCharts(const SweepResults& results);
[[nodiscard]] DataTable tunnellingTable(const SweepResults& results);
[[nodiscard]] DataTable moversTable(const SweepResults& results,
                                    std::span<const MotionResult> motions);
/// The same for all motions, of the columns that matter most.
[[nodiscard]] DataTable shortMoversTable(const SweepResults& results);
[[nodiscard]] std::vector<Check> sweepChecks(const SweepResults& results);

/// All tallies of a method, of both parts.
[[nodiscard]] SweepTally totalOf(const SweepResults& results, std::size_t method);
/// The same, of walls alone.
[[nodiscard]] SweepTally wallsOf(const SweepResults& results, std::size_t method);

/// "100 cells a frame"
[[nodiscard]] std::string motionText(double motion);

}  // namespace hashphase::demos
