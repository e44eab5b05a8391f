// SPDX-License-Identifier: Zlib
#pragma once

// P4, its parts.

#include <demos/accuracy/culling/culling_methods.hpp>
#include <demos/accuracy/experiment.hpp>

#include <cstdint>
#include <span>

namespace hashphase::demos {

/// How much is measured.
struct CullingPlan {
    std::size_t objects;
    std::size_t touching;  // in each view, its sides
    int flights;           // for each setting; a flight is kViewsPerFlight views, one after another
    int frames;            // that are timed; a flight each
};

/// Counts what the methods get wrong, in all settings, and times them in the first one with all cell
/// sizes; says what it shows (culling.sql).
[[nodiscard]] Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                                   std::span<const CullingMethod> methods,
                                   const TellProgress& tell);

}  // namespace hashphase::demos
