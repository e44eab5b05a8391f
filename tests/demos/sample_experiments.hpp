// SPDX-License-Identifier: Zlib
#pragma once

// Experiments that measure nothing, for tests of what is done with findings.

#include <demos/accuracy/experiment.hpp>

#include <vector>

namespace hashphase::demos {

/// A chart of every mark, with all that a chart can have, and texts that are hard to write.
[[nodiscard]] std::vector<Chart> sampleCharts();

/// S1 finds the sample charts and what goes with them, S2 nothing; all checks hold.
[[nodiscard]] std::vector<Experiment> sampleExperiments();

}  // namespace hashphase::demos
