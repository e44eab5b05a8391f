// SPDX-License-Identifier: Zlib
#pragma once

// The experiments, one file each.

#include <demos/accuracy/experiment.hpp>

namespace hashphase::demos {

[[nodiscard]] Experiment cullingExperiment();
[[nodiscard]] Experiment pickingExperiment();
[[nodiscard]] Experiment terrainExperiment();
[[nodiscard]] Experiment originExperiment();
[[nodiscard]] Experiment timeStepExperiment();
[[nodiscard]] Experiment trajectoryExperiment();

}  // namespace hashphase::demos
