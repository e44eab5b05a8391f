// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/pairs/cell_size.hpp>

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
    [[nodiscard]] std::optional<double> bytesPerObject(std::size_t method) const;

    // Methods that were timed.
    [[nodiscard]] std::optional<std::size_t> automatic() const;
    [[nodiscard]] std::optional<std::size_t> bestFixed() const;  // the fastest
    [[nodiscard]] std::optional<std::size_t> bullet() const;

    /// How much longer the automatic sizes take than the best fixed one, as a share.
    [[nodiscard]] std::optional<double> regret() const;
};

}  // namespace hashphase::demos
