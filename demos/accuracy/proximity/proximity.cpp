// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/proximity/proximity_findings.hpp>
#include <demos/console/format.hpp>
#include <demos/report/data_table.hpp>

#include <numbers>

namespace hashphase::demos {
namespace {

ProximityCase crowdOf(std::size_t agents, double neighbours, double radiusByCell) {
    ProximityCase crowd;
    crowd.agents = agents;
    crowd.neighbours = neighbours;
    crowd.radiusByCell = radiusByCell;
    crowd.hasAllMethods = radiusByCell == 1;
    crowd.name = withThousands(agents) + " agents, each with " + valueText(neighbours) +
                 " others within 5 m";
    return crowd;
}

/// FLAME GPU's benchmark: one agent a square metre, who sees 2 m far.
ProximityCase circles(std::size_t agents) {
    ProximityCase crowd = crowdOf(agents, 4 * std::numbers::pi, 1);
    crowd.radius = 2;
    crowd.name = "Circles: " + withThousands(agents) + " agents, one a square metre, radius 2 m";
    return crowd;
}

}  // namespace

ProximityExperimentPlan proximityPlan(const Effort& effort) {
    ProximityExperimentPlan plan;
    plan.trial.mostJudgedAgents = effort.quickOrFull<std::size_t>(300, 1000);
    const auto agents = effort.quickOrFull<std::size_t>(1'200, 5'000);
    for (const double ratio :
         effort.isQuick ? std::vector{0.5, 1.0, 4.0} : std::vector{0.1, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        plan.crowds.push_back(crowdOf(agents, 20, ratio));
    }
    plan.crowds.push_back(circles(agents));
    if (effort.isQuick) {
        return plan;
    }
    for (const double ratio : {1.0, 4.0}) {
        plan.crowds.push_back(crowdOf(10'000, 20, ratio));
    }
    for (const double neighbours : {5.0, 80.0}) {
        plan.crowds.push_back(crowdOf(agents / 2, neighbours, 1));
    }
    return plan;
}

std::vector<NeighbourMethod> neighbourMethods() {
    return {rarestColourMethod(),     crowdMethod(),
            findWithinMethod(),       ballBoxMethod(),
            estimateMethod(),         countedCellsMethod(),
            firstFewMethod(4),        firstFewMethod(16),
            staleNeighboursMethod(2), staleNeighboursMethod(4),
            staleNeighboursMethod(8), paperProximityMethod(),
            bulletProximityMethod()};
}

Findings measureProximity(const ProximityExperimentPlan& plan,
                          std::span<const NeighbourMethod> methods, std::uint64_t seed,
                          const TellProgress& tell) {
    std::vector<ProximityResult> results;
    for (const ProximityCase& crowd : plan.crowds) {
        tell(static_cast<double>(results.size()) / static_cast<double>(plan.crowds.size()),
             crowd.name);
        ProximityResult result{crowd, {}, {}};
        for (const NeighbourMethod& method : methods) {
            if (crowd.hasAllMethods || method.usesCells) {
                result.methods.push_back(method);
            }
        }
        result.measurements = tryProximity(crowd, result.methods, plan.trial, seed);
        results.push_back(std::move(result));
    }
    return proximityFindings(results, checkStatedEstimates(plan.statedEstimates, seed));
}

Experiment proximityExperiment() {
    return {
        "P3",
        "Proximity for AI",
        "What does an agent get wrong that asks only roughly who is near, and what does it save?",
        5,
        100,
        [](const Effort& effort, const TellProgress& tell) {
            return measureProximity(proximityPlan(effort), neighbourMethods(), effort.seed, tell);
        }};
}

}  // namespace hashphase::demos
