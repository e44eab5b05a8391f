// SPDX-License-Identifier: Zlib
#pragma once

// P4, its parts.

#include <demos/accuracy/culling/culling_methods.hpp>
#include <demos/accuracy/culling/culling_scenes.hpp>
#include <demos/accuracy/experiment.hpp>
#include <demos/report/statistics.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// How much is measured.
struct CullingPlan {
    std::size_t objects;
    std::size_t touching;  // in each view, its sides
    int flights;           // for each setting; a flight is kViewsPerFlight views, one after another
    int frames;            // that are timed; a flight each
};

/// What a method did in all views of a setting.
struct CullingTally {
    std::uint64_t visible = 0;
    std::uint64_t lost = 0;    // of these, not drawn
    std::uint64_t inVain = 0;  // drawn, not visible
    CullingCost cost;
    int views = 0;
};

/// One method in one setting; timed or not.
struct CullingRow {
    const CullingMethod* method;
    const CullingSetting* setting;
    CullingTally tally;
    bool isTimed = false;
    Spread microseconds = {};  // a view

    /// The method, and the cell size where it takes one.
    [[nodiscard]] std::string name() const;
};

/// One factor after another around the first setting.
[[nodiscard]] std::vector<CullingSetting> cullingSettings();

struct CullingMeasurement {
    std::vector<CullingRow> rows;      // of objects on the ground, in all settings
    std::vector<CullingRow> touching;  // of objects that touch the view's sides, or just do not
};

/// Counts what the methods get wrong in all settings, and times them in the first one with all cell
/// sizes.
[[nodiscard]] CullingMeasurement measureCulling(const CullingPlan& plan, std::uint64_t seed,
                                                std::span<const CullingMethod> methods,
                                                std::span<const CullingSetting> settings,
                                                const TellProgress& tell);

/// Measures, and says what it shows.
[[nodiscard]] Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                                   std::span<const CullingMethod> methods,
                                   const TellProgress& tell);

}  // namespace hashphase::demos
