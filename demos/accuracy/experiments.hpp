// SPDX-License-Identifier: Zlib
#pragma once

// The experiments, a folder each.

#include <demos/accuracy/experiment.hpp>

#include <span>

namespace hashphase::demos {

[[nodiscard]] Experiment sweepExperiment();       // P1
[[nodiscard]] Experiment cellSizeExperiment();    // P2
[[nodiscard]] Experiment proximityExperiment();   // P3
[[nodiscard]] Experiment cullingExperiment();     // P4
[[nodiscard]] Experiment pickingExperiment();     // P5
[[nodiscard]] Experiment originExperiment();      // P6
[[nodiscard]] Experiment timeStepExperiment();    // P7
[[nodiscard]] Experiment trajectoryExperiment();  // P8
[[nodiscard]] Experiment terrainExperiment();     // P9
[[nodiscard]] Experiment updateExperiment();      // P10

/// All of them, in that order.
[[nodiscard]] std::span<const Experiment> experiments();

}  // namespace hashphase::demos
