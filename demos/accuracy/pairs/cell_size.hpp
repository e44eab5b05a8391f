// SPDX-License-Identifier: Zlib
#pragma once

// P2: what the size of cells costs.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/pairs/pair_trial.hpp>
#include <demos/scenes/scatter.hpp>

namespace hashphase::demos {

/// A way to divide space.
struct CellMethod {
    PairMethod pairs;
    std::optional<double> factor = {};  // cell by mean edge; none where there is no such choice
    bool isAutomatic = false;           // competes with our fixed sizes
    double filingCellSize = 0;  // objects are filed in every cell of this size; 0: they are not

    [[nodiscard]] bool isFixed() const { return factor && pairs.origin == kOurs; }

    /// "levels, cells 0.5", the factor last.
    [[nodiscard]] std::string name() const;
};

/// A population: where the boxes lie, and how many there are.
struct CellCase {
    std::string population;
    ScatterPlan plan;
    std::size_t objects = 0;
    std::vector<double> factors;
    int judgedFrames = 2;

    [[nodiscard]] std::string name() const;
};

/// The ways to be compared for boxes of that mean edge [m].
using CellMethods = std::function<std::vector<CellMethod>(const CellCase& each, double meanEdge)>;

[[nodiscard]] std::vector<CellCase> cellCases(const Effort& effort);
[[nodiscard]] std::vector<CellMethod> cellMethods(const CellCase& each, double meanEdge);

/// The experiment, on these cases with these methods.
[[nodiscard]] Findings measureCellSizes(std::span<const CellCase> cases, const CellMethods& methods,
                                        const Effort& effort, const TellProgress& tell);

}  // namespace hashphase::demos
