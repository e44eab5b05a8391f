// SPDX-License-Identifier: Zlib
#pragma once

// P5, its parts.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/picking/ray_methods.hpp>

namespace hashphase::demos {

/// How much is measured.
struct PickingPlan {
    std::size_t boxes;  // in the slab
    int graze;          // rays for each contact and offset
    int frames;         // that are timed
    std::size_t raysPerFrame;
    std::size_t strungBoxes;  // along all long rays of one length
    int longestPower;         // of ten: the longest ray [m], and so about as many cells
    double metresInAll;       // of the long rays of one length, if there is more than one
    double longestCellWalk;   // of methods that take time for each cell [m]
};

/// Measures, and says what it shows (picking.sql).
[[nodiscard]] Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                                   std::span<const RayMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
