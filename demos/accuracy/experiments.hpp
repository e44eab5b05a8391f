// SPDX-License-Identifier: Zlib
#pragma once

// The experiments, one file each.

#include <demos/accuracy/experiment.hpp>

namespace hashphase::demos {

[[nodiscard]] Experiment sweepExperiment();  // P1

}  // namespace hashphase::demos
