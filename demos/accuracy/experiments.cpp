// SPDX-License-Identifier: Zlib
#include <demos/accuracy/experiments.hpp>

#include <demos/accuracy/accuracy.hpp>

#include <vector>

namespace hashphase::demos {

std::span<const Experiment> experiments() {
    static const std::vector<Experiment> all{sweepExperiment()};
    return all;
}

}  // namespace hashphase::demos
