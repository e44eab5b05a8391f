// SPDX-License-Identifier: Zlib
#pragma once

// P6: what becomes of pairs, rays and resting bodies far from the origin, and what it costs to have
// them right.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/origin/origin_run.hpp>
#include <demos/accuracy/origin/origin_settle.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

struct OriginSettings {
    std::vector<double> offsets;  // 0 first, then powers of two, ascending, up to 2^30 [m]
    std::size_t boxes = 1000;
    std::size_t rays = 50;
    std::uint64_t seed = 1;
};

/// Whether this power of two is the one next to a power of ten.
[[nodiscard]] bool isNextToPowerOfTen(double offset);

/// What was measured at one distance.
struct OriginPoint {
    double offset = 0;
    OriginOutcomes fine;    // boxes of about a metre
    OriginOutcomes coarse;  // of kilometres, so that all coordinates are exact in single precision
    std::vector<SettleOutcome> settled;
};

[[nodiscard]] std::vector<OriginPoint> runOrigin(std::span<const OriginMethod> methods,
                                                 std::span<const SettleMethod> settleMethods,
                                                 const OriginSettings& settings,
                                                 const TellProgress& tell);

[[nodiscard]] Findings judgeOrigin(std::span<const OriginMethod> methods,
                                   std::span<const SettleMethod> settleMethods,
                                   const OriginSettings& settings,
                                   std::span<const OriginPoint> points);

}  // namespace hashphase::demos
