// SPDX-License-Identifier: Zlib
#pragma once

// P4, its parts.

#include <demos/accuracy/culling_methods.hpp>
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
    int flights;  // for each setting; a flight is kViewsPerFlight views, one after another
    int frames;   // that are timed; a flight each
};

inline constexpr int kViewsPerFlight = 8;

/// Where the camera looks, and at what.
struct CullingSetting {
    std::string name;
    float fieldOfView = 60;  // [degrees]
    float pitch = -45;       // [degrees]
    float yaw = 20;          // [degrees]
    float tallest = 10;      // [m]
    float cellSize = 10;     // [m]
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

/// Counts what the methods get wrong in all settings, and times them in the first one with all cell
/// sizes.
[[nodiscard]] std::vector<CullingRow> measureCulling(const CullingPlan& plan, std::uint64_t seed,
                                                     std::span<const CullingMethod> methods,
                                                     std::span<const CullingSetting> settings,
                                                     const TellProgress& tell);

/// Measures, and says what it shows.
[[nodiscard]] Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                                   std::span<const CullingMethod> methods,
                                   const TellProgress& tell);

}  // namespace hashphase::demos
