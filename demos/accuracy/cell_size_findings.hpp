// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/cell_size.hpp>

namespace hashphase::demos {

/// What was measured on one population.
struct CellCaseResult {
    std::string name;
    std::string population;
    std::size_t objects = 0;
    double largestEdgeByMean = 0;
    std::vector<CellMethod> methods;
    PairTrial trial;  // a measurement for each method

    /// [ns] an object and frame, where it was timed.
    [[nodiscard]] std::optional<double> nanosecondsOf(std::size_t method) const;
};

/// "0.25", "2".
[[nodiscard]] std::string factorText(double factor);

/// Tables, charts, checks, choices and conclusions.
[[nodiscard]] Findings cellSizeFindings(std::span<const CellCaseResult> results);

}  // namespace hashphase::demos
