// SPDX-License-Identifier: Zlib
#pragma once

// How many of those that an estimate by cells finds are really near. Agents of edge e lie anywhere.
// The cells that the box of a ball of radius r touches are 2 r + c wide on average, c being their
// edge, and an agent touches them when its centre is at most e / 2 outside; so
//
//     on a plain   pi r^2 / (2 r + c + e)^2
//     in space     4/3 pi r^3 / (2 r + c + e)^3

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

[[nodiscard]] double estimatePrecisionOnPlain(double radius, double cellSize, double edge);
[[nodiscard]] double estimatePrecisionInSpace(double radius, double cellSize, double edge);

/// What integration/ai/proximity.hpp states of estimateWithin() in space, and what was counted.
struct StatedEstimate {
    double radiusByCell = 0;
    double statedTenths = 0;  // "1, 2, 3 and 4 in 10"
    double theory = 0;
    std::uint64_t found = 0;   // by the estimate
    std::uint64_t within = 0;  // of these
    std::uint64_t missed = 0;
    std::uint64_t tooFar = 0;  // beyond sqrt(3) (radius + cell size) from centre to box

    [[nodiscard]] double precision() const;
};

/// For a radius of 1, 2, 4 and 8 cells, agents half as large as a cell, twenty others in the ball.
/// `estimates` queries each.
[[nodiscard]] std::vector<StatedEstimate> checkStatedEstimates(std::size_t estimates,
                                                               std::uint64_t seed);

}  // namespace hashphase::demos
