// SPDX-License-Identifier: Zlib
#pragma once

// All that `hashphase paper` measures: the three figures, and what the paper leaves open.

#include <demos/paper/bounding_volumes.hpp>
#include <demos/paper/phase_measurement.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

inline constexpr float kAiRadius = 10;  // [m]; the paper does not give it

struct PaperPlan {
    std::vector<std::uint32_t> objects{kPrintedObjects.begin(), kPrintedObjects.end()};
    std::uint64_t seed = 1;
    float aiRadius = kAiRadius;
    std::uint32_t sweepObjects = 20'000;  // of the sweeps of radius and cell size
    std::uint32_t sticks = 10'000;
    PhaseEffort effort;
};

/// Who is told, and asked, while it is measured.
struct PaperWatch {
    IsTimeUp isTimeUp = [] { return false; };
    std::function<void(std::size_t done, std::string_view what)> tellProgress =
        [](std::size_t, std::string_view) {};
};

struct PaperResults {
    PaperPlan plan;
    std::vector<PhaseResult> figures;  // by phase, then by number of objects
    std::vector<PhaseResult> radii;    // AI by radius
    std::vector<double> neighbours;    // of an agent on average, by radius
    PhaseResult cellSizes;             // collision
    VolumeResults volumes;
    std::vector<std::string> leftOut;  // for want of time
    std::vector<PaperCheck> checks;

    /// Null where it was left out.
    [[nodiscard]] const PhaseResult* figure(Phase phase, std::uint32_t objects) const;

    /// Of all checks together: broken by one that is; not checked where one is not, or there is none.
    [[nodiscard]] CheckOutcome outcome() const;
};

/// Of some cells of a figure.
struct CellTally {
    std::size_t tooSlow = 0;    // so marked in the paper, of what was measured
    std::size_t today = 0;      // of these, where the paper's method is fast enough today
    std::size_t hashphase = 0;  // of these, where hashphase is
};

/// How the paper's cells that are too slow for real time fare today, by phase.
struct RealTimeTally {
    std::array<CellTally, kPhases.size()> grid;         // with the cell sizes of the paper
    std::array<CellTally, kPhases.size()> unoptimized;  // beside hashphase with automatic cells
};
[[nodiscard]] RealTimeTally tallyRealTime(const PaperResults& results);

/// Where the paper's grid is faster today than hashphase at the same cell size.
struct LossTally {
    std::size_t compared = 0;
    std::size_t lost = 0;
    double worstRatio = 1;  // of the times, where most is lost
    std::string worst;      // "visibility of 5,000, cells of 100 m"
};
[[nodiscard]] LossTally tallyLosses(const PaperResults& results);

[[nodiscard]] PaperResults measurePaper(const PaperPlan& plan, const PaperWatch& watch = {});

/// How many steps it tells of.
[[nodiscard]] std::size_t paperSteps(const PaperPlan& plan);

}  // namespace hashphase::demos
