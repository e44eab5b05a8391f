// SPDX-License-Identifier: Zlib
#pragma once

// P2: what the size of cells costs.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/pairs/pair_trial.hpp>
#include <demos/scenes/scatter.hpp>

namespace hashphase::demos {

/// A population: where the boxes lie, and how many there are.
struct CellCase {
    std::string population;
    ScatterPlan plan;
    std::size_t objects = 0;
    std::vector<double> factors = {};  // of cell sizes, by the mean edge
    int judgedFrames = 2;

    [[nodiscard]] std::string name() const;
};

/// The ways to be compared for these boxes, of that mean edge [m].
using CellMethods = std::function<std::vector<PairMethod>(
    const CellCase& each, std::span<const BulletBox> boxes, double meanEdge)>;

/// All ways: automatic sizes and fixed ones, the paper's grids where an object does not lie in too
/// many cells, and btDbvtBroadphase.
[[nodiscard]] std::vector<PairMethod> cellMethods(const CellCase& each,
                                                  std::span<const BulletBox> boxes,
                                                  double meanEdge);

/// The experiment, on these cases with these methods (cell_size.sql).
[[nodiscard]] Findings measureCellSizes(std::span<const CellCase> cases, const CellMethods& methods,
                                        std::uint64_t seed, const TellProgress& tell);

}  // namespace hashphase::demos
