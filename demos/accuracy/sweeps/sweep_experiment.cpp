// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

/// 0.1 to 1000, evenly on a logarithmic axis.
std::vector<double> ratiosPerDecade(int count) {
    std::vector<double> ratios;
    for (int i = 0; i <= 4 * count; ++i) {
        ratios.push_back(std::pow(10.0, static_cast<double>(i) / count - 1));
    }
    return ratios;
}

std::string missedText(const SweepTally& tally) {
    return tally.missed == 0 ? "misses none of " + withThousands(tally.contacts) + " contacts"
                             : "misses " + valueText(100 * tally.missedShare()) + " % of contacts";
}

// What lists false pairs leaves their test to others: it does not compete with what tests them.
void addChoices(const SweepResults& results, std::vector<Choice>& choices) {
    const FastMoversPlan& plan = results.plan.movers;
    for (const MotionResult& at : results.motions) {
        const std::string task = "Fast movers: " + withThousands(plan.movers) + " of " +
                                 withThousands(plan.objects) + " at " + motionText(at.motion);
        for (std::size_t i = 0; i < results.methods.size(); ++i) {
            const SweepMethod& method = results.methods[i];
            const SweepTally& tally = at.tallies[i];
            if (method.inventsNothing) {
                choices.push_back({task, method.name, at.milliseconds[i].median,
                                   tally.missedShare(), missedText(tally),
                                   method.origin == SweepOrigin::ours});
            }
        }
    }
}

std::string missingSentence(const SweepResults& results) {
    std::string text = "Bullets at walls:";
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        text +=
            (i == 0 ? " " : "; ") + results.methods[i].name + " " + missedText(wallsOf(results, i));
    }
    return text + ".";
}

std::string bodiesSentence(const SweepResults& results) {
    std::string text = "Bodies in Bullet's world that came out behind the wall";
    for (const bool isContinuous : {false, true}) {
        FlyingBodiesPoint sum{0, isContinuous};
        for (const FlyingBodiesPoint& point : results.bodies) {
            const bool counts = point.isContinuous == isContinuous;
            sum.bodies += counts ? point.bodies : 0;
            sum.tunnelled += counts ? point.tunnelled : 0;
        }
        text += std::string(isContinuous ? "; with " : ": without ") +
                "continuous collision detection " + withThousands(sum.tunnelled) + " of " +
                withThousands(sum.bodies);
    }
    return text + ".";
}

/// The fastest of those that see every contact and list nothing else, against Bullet's.
std::string costSentence(const SweepResults& results, const MotionResult& at) {
    const auto fastest = [&](SweepOrigin origin) -> std::optional<std::size_t> {
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < results.methods.size(); ++i) {
            const SweepTally& tally = at.tallies[i];
            if (results.methods[i].origin == origin && tally.missed + tally.invented == 0 &&
                (!best || at.milliseconds[i].median < at.milliseconds[*best].median)) {
                best = i;
            }
        }
        return best;
    };
    const auto describe = [&](std::string_view whose, SweepOrigin origin) {
        const auto best = fastest(origin);
        return std::string(whose) + (best ? results.methods[*best].name + " in " +
                                                milliseconds(at.milliseconds[*best].median) + " ms"
                                          : std::string("none"));
    };
    return "At " + motionText(at.motion) + ", the fastest that erred nowhere is, of ours, " +
           describe("", SweepOrigin::ours) + "; with the paper's grid, " +
           describe("", SweepOrigin::paper) + "; of Bullet's, " +
           describe("", SweepOrigin::bullet) + ".";
}

}  // namespace

SweepPlan sweepPlan(const Effort& effort) {
    SweepPlan plan;
    plan.tunnelling.thicknesses = {0.001, 0.01, 0.1, 1};
    plan.tunnelling.ratios = ratiosPerDecade(effort.quickOrFull(2, 4));
    plan.tunnelling.frames = effort.quickOrFull(64, 768);
    plan.bodyRounds = effort.quickOrFull(1, 4);
    plan.movers.objects = effort.quickOrFull(6'000U, 30'000U);
    plan.movers.movers = effort.quickOrFull(50U, 1'000U);
    plan.movers.motions = {{1, effort.quickOrFull(200, 100)},
                           {10, effort.quickOrFull(40, 32)},
                           {100, effort.quickOrFull(10, 8)}};
    plan.movers.timedFrames = 60;
    return plan;
}

SweepTally wallsOf(const SweepResults& results, std::size_t method) {
    SweepTally sum;
    for (const TunnellingPoint& point : results.points) {
        sum += point.tallies[method];
    }
    return sum;
}

SweepTally totalOf(const SweepResults& results, std::size_t method) {
    SweepTally sum = wallsOf(results, method);
    for (const MotionResult& at : results.motions) {
        sum += at.tallies[method];
    }
    return sum;
}

Findings measureSweeps(const SweepPlan& plan, std::span<const SweepMethod> methods,
                       std::uint64_t seed, const TellProgress& tell) {
    constexpr double kShareOfWalls = 0.4;  // of the time, about
    SweepResults results{plan, methods, seed, {}, {}, {}};
    results.points = measureTunnelling(
        plan.tunnelling, methods, seed,
        [&](double share, std::string_view what) { tell(kShareOfWalls * share, what); });
    tell(kShareOfWalls, "bodies at walls");
    results.bodies = measureFlyingBodies(plan.tunnelling.thicknesses, plan.tunnelling.ratios,
                                         plan.bodyRounds, seed);
    results.motions =
        measureFastMovers(plan.movers, methods, seed, [&](double share, std::string_view what) {
            tell(kShareOfWalls + (1 - kShareOfWalls) * share, what);
        });

    Findings findings;
    findings.charts = sweepCharts(results);
    findings.tables = {tunnellingTable(results), shortMoversTable(results)};
    findings.checks = sweepChecks(results);
    for (const Chart* chart : {&findings.charts.front(), &findings.charts.back()}) {
        findings.settings.push_back(chart->name + ": " + chart->settings + ".");
    }
    findings.settings.insert(
        findings.settings.end(),
        {"Contacts that last from the frame before are left out, for all. Discrete methods know "
         "the "
         "boxes at the end of the frame.",
         "What shares a cell with the paper's methods counts when the boxes around the ways "
         "overlap. Its grid files what stands once, is told its cell size, and keeps no pairs from "
         "frame to frame, as the others do.",
         "False pairs of btDbvtBroadphase, united, are also those that it keeps from earlier "
         "frames.",
         "Bullet's bodies are spheres without gravity; with CCD, their motion threshold and swept "
         "sphere radius are their radius. Stopped are those that are not behind the wall at the "
         "end."});
    addChoices(results, findings.choices);
    findings.conclusions = {missingSentence(results), bodiesSentence(results)};
    for (const MotionResult& at : results.motions) {
        findings.conclusions.push_back(costSentence(results, at));
    }
    return findings;
}

Experiment sweepExperiment() {
    return {"P1",
            "Fast objects",
            "What do fast objects fly through unseen, and what does it cost to see it all?",
            4,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                const SweepPlan plan = sweepPlan(effort);
                return measureSweeps(plan, sweepMethods(), effort.seed, tell);
            }};
}

}  // namespace hashphase::demos
