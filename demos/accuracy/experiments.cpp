// SPDX-License-Identifier: Zlib
#include <demos/accuracy/experiments.hpp>

#include <demos/accuracy/accuracy.hpp>

#include <vector>

namespace hashphase::demos {

std::span<const Experiment> experiments() {
    static const std::vector<Experiment> all{
        sweepExperiment(),   cellSizeExperiment(), proximityExperiment(), cullingExperiment(),
        pickingExperiment(), originExperiment(),   timeStepExperiment(),  trajectoryExperiment(),
        terrainExperiment(), updateExperiment(),
    };
    return all;
}

}  // namespace hashphase::demos
