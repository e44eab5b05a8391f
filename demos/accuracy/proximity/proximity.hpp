// SPDX-License-Identifier: Zlib
#pragma once

// P3: what an AI agent that asks only roughly who is near gets wrong, and what it saves.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/proximity/proximity_trial.hpp>

namespace hashphase::demos {

/// What was measured in one crowd.
struct ProximityResult {
    ProximityCase crowd;
    std::vector<NeighbourMethod> methods;
    std::vector<ProximityMeasurement> measurements;  // one a method
};

struct ProximityExperimentPlan {
    std::vector<ProximityCase> crowds;
    ProximityPlan trial;
    std::size_t statedEstimates = 300;
};

[[nodiscard]] ProximityExperimentPlan proximityPlan(const Effort& effort);
[[nodiscard]] std::vector<NeighbourMethod> neighbourMethods();

/// The experiment, with these methods.
[[nodiscard]] Findings measureProximity(const ProximityExperimentPlan& plan,
                                        std::span<const NeighbourMethod> methods,
                                        std::uint64_t seed, const TellProgress& tell);

}  // namespace hashphase::demos
