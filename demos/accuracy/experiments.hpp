// SPDX-License-Identifier: Zlib
#pragma once

// The experiments, one file each.

#include <demos/accuracy/experiment.hpp>

namespace hashphase::demos {

[[nodiscard]] Experiment cellSizeExperiment();   // P2
[[nodiscard]] Experiment proximityExperiment();  // P3
[[nodiscard]] Experiment updateExperiment();     // P10

}  // namespace hashphase::demos
