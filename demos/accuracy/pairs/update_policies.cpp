// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/update_policies.hpp>

#include <demos/accuracy/baselines/paper_grid.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/pairs/pair_findings.hpp>
#include <demos/accuracy/pairs/update_policy.hpp>
#include <demos/console/format.hpp>
#include <demos/scenes/scatter.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr double kCentimetres = 100;  // in a metre

struct MotionResult {
    Motion motion;
    PairTrial trial;
};

struct Results {
    const UpdatePlan& plan;
    std::span<const PairMethod> policies;
    std::vector<MotionResult> motions;
    std::string settings;

    [[nodiscard]] double nanoseconds(const MotionResult& at, std::size_t policy) const {
        return at.trial.measurements[policy].time->median * 1e6 / static_cast<double>(plan.objects);
    }
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const {
        for (std::size_t i = 0; i < policies.size(); ++i) {
            if (policies[i].name == name) {
                return i;
            }
        }
        return std::nullopt;
    }
    [[nodiscard]] std::optional<double> bulletNanoseconds(const MotionResult& at) const {
        const auto bullet = find(dbvtMethod(false).name);
        return bullet ? std::optional(nanoseconds(at, *bullet)) : std::nullopt;
    }

    /// The motions that differ from the first in their share only; they come first.
    [[nodiscard]] std::span<const MotionResult> alike() const {
        const auto end = std::find_if(motions.begin(), motions.end(), [&](const auto& each) {
            return each.motion.step != motions.front().motion.step;
        });
        return {motions.begin(), end};
    }
};

PairTrial measureMotion(const UpdatePlan& plan, std::span<const PairMethod> policies,
                        const Motion& motion, std::uint64_t seed) {
    ScatterPlan scatterPlan;
    scatterPlan.movingShare = static_cast<float>(motion.share);
    scatterPlan.step = static_cast<float>(motion.step);
    BrownianScene scene(scatter(scatterPlan, plan.objects, seed), seed);
    PairTrialPlan trialPlan;
    trialPlan.judgedFrames = plan.judgedFrames;
    trialPlan.rounds = plan.rounds;
    trialPlan.framesTogether = plan.framesTogether;
    return tryPairs(scene, policies, trialPlan);
}

DataTable resultTable(const Results& results, std::span<const MotionResult> motions) {
    DataTable table{pairColumns(), {}};
    table.columns.insert(table.columns.begin(), {{"policy", "policy"},
                                                 {"motion", "how many boxes move, and how far"},
                                                 {"moving_percent", "boxes that move [%]"}});
    for (const MotionResult& at : motions) {
        for (std::size_t i = 0; i < results.policies.size(); ++i) {
            std::vector<Value> row =
                pairValues(at.trial.measurements[i], results.nanoseconds(at, i),
                           results.bulletNanoseconds(at));
            row.insert(row.begin(),
                       {results.policies[i].name, at.motion.name(), 100 * at.motion.share});
            table.add(std::move(row));
        }
    }
    return table;
}

Chart breakEvenChart(const Results& results) {
    Chart chart;
    chart.name = "P10-break-even";
    chart.title =
        "Time against the share of boxes that move: where lines cross, policies break even";
    chart.settings = results.settings;
    chart.data = resultTable(results, results.alike());
    chart.x = {"moving_percent", AxisScale::kLinear};
    chart.y = {"ns", AxisScale::kLog};
    chart.series = "policy";
    return chart;
}

Chart errorChart(const Results& results, bool isMissed) {
    Chart chart;
    chart.name = isMissed ? "P10-missed" : "P10-false";
    chart.title = isMissed ? "Missed pairs against time: wrong answers"
                           : "False pairs against time: work for those who come after";
    chart.settings = results.settings;
    chart.mark = ChartMark::kPoint;
    chart.data = resultTable(results, results.motions);
    chart.x = {"ns", AxisScale::kLog};
    chart.y = {isMissed ? "missed_share" : "false_share", AxisScale::kLogAndZero};
    chart.series = "policy";
    chart.label = "motion";
    chart.showFront = true;
    if (isMissed) {
        chart.low = "missed_low";
        chart.high = "missed_high";
    }
    return chart;
}

Chart errorBars(const Results& results, const MotionResult& at, bool isMissed) {
    Chart chart = errorChart(results, isMissed);
    chart.name += "-by-policy-" + valueText(kCentimetres * at.motion.step) + "-cm";
    chart.title =
        std::string(isMissed ? "Missed" : "False") + " pairs by policy: " + at.motion.name();
    chart.mark = ChartMark::kBar;
    chart.data = resultTable(results, {&at, 1});
    chart.x = {"policy", AxisScale::kNames};
    chart.y.scale = AxisScale::kLinear;
    chart.label.clear();
    chart.showFront = false;
    return chart;
}

/// Where nothing moves, there is nothing to miss, whatever one is not told.
Check stillnessCheck(const Results& results) {
    std::uint64_t missed = 0;
    std::uint64_t truePairs = 0;
    for (const MotionResult& at : results.motions) {
        for (const PairMeasurement& each : at.trial.measurements) {
            if (at.motion.share == 0) {
                missed += each.missed;
                truePairs += each.truePairs;
            }
        }
    }
    return {"No policy misses a pair where nothing moves", missed == 0,
            withThousands(missed) + " of " + withThousands(truePairs)};
}

/// What lists false pairs for the sake of speed leaves their test to others: it does not compete with
/// the same way that tests them itself.
bool isUnfinished(const PairMethod& policy) {
    return policy.origin == kOurs && policy.isComplete && !policy.isExact;
}

void addChoices(const Results& results, std::vector<Choice>& choices) {
    for (const MotionResult& at : results.motions) {
        if (!at.motion.isTask) {
            continue;
        }
        const std::string task =
            "Pairs of " + withThousands(results.plan.objects) + " boxes, " + at.motion.name();
        for (std::size_t i = 0; i < results.policies.size(); ++i) {
            const PairMeasurement& measured = at.trial.measurements[i];
            if (isUnfinished(results.policies[i])) {
                continue;
            }
            choices.push_back({task, results.policies[i].name, measured.time->median,
                               missedShare(measured), pairResultText(measured),
                               results.policies[i].origin == kOurs});
        }
    }
}

/// At which shares of moving boxes `policy` is faster than `other`.
std::string breakEvenSentence(const Results& results, std::string_view policy,
                              std::string_view other) {
    const auto a = results.find(policy);
    const auto b = results.find(other);
    if (!a || !b) {
        return {};
    }
    std::string faster;
    std::string slower;
    for (const MotionResult& at : results.alike()) {
        const double ratio = results.nanoseconds(at, *b) / results.nanoseconds(at, *a);
        std::string& list = ratio >= 1 ? faster : slower;
        list += (list.empty() ? "" : ", ") + percentText(at.motion.share) + " (" +
                fixed(ratio, ratio < 10 ? 2 : 0) + "x)";
    }
    return "'" + std::string(policy) + "' against '" + std::string(other) + "': faster where " +
           (faster.empty() ? "nothing" : faster) + " of the boxes move; slower at " +
           (slower.empty() ? "none of the shares" : slower) + ".";
}

std::string fastestSentence(const Results& results) {
    std::string text = "The fastest exact policy";
    for (const MotionResult& at : results.motions) {
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < results.policies.size(); ++i) {
            if (results.policies[i].isExact &&
                (!best || results.nanoseconds(at, i) < results.nanoseconds(at, *best))) {
                best = i;
            }
        }
        if (best) {
            text += (&at == &results.motions.front() ? " where " : "; where ") + at.motion.name() +
                    ": '" + results.policies[*best].name + "' (" +
                    fixed(results.nanoseconds(at, *best), 1) + " ns an object)";
        }
    }
    return text + ".";
}

std::string errorSentence(const Results& results, const MotionResult& at) {
    std::string text = "Where " + at.motion.name() + ":";
    for (std::size_t i = 0; i < results.policies.size(); ++i) {
        const PairMeasurement& measured = at.trial.measurements[i];
        if (!results.policies[i].isExact) {
            text += (text.back() == ':' ? " '" : "; '") + results.policies[i].name + "' " +
                    pairResultText(measured);
        }
    }
    return text + ".";
}

std::string settingsText(const UpdatePlan& plan) {
    return withThousands(plan.objects) +
           " boxes with edges of 0.5-1.5 m, each overlapping about two others; those that move do "
           "so by up to the given way on each axis and frame. A frame is the calls of setAabb and "
           "all pairs, the pair "
           "cache included (the paper's grid keeps none); means of " +
           std::to_string(plan.framesTogether) + " frames in a row, medians of " +
           std::to_string(plan.rounds) + " such means.";
}

}  // namespace

std::string Motion::name() const {
    return share == 0 ? "none move"
                      : (share == 1 ? "all" : percentText(share)) + " move by " +
                            valueText(kCentimetres * step) + " cm";
}

UpdatePlan updatePlan(const Effort& effort) {
    UpdatePlan plan;
    plan.objects = effort.quickOrFull<std::size_t>(2'000, 10'000);
    for (const double share : effort.isQuick ? std::vector{0.0, 0.05, 0.5, 1.0}
                                             : std::vector{0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0}) {
        plan.motions.push_back({share});
        plan.motions.back().isTask = share == 0.05 || share == 0.5 || share == 1;
    }
    constexpr double kFast = 0.2;  // up to 12 m/s at 60 frames a second
    plan.motions.push_back({1, kFast});
    plan.judgedFrames = effort.quickOrFull(8, 16);
    plan.rounds = effort.quickOrFull(16, 30);
    return plan;
}

std::vector<PairMethod> updatePolicies() {
    std::vector<PairMethod> policies{hashMethod("moved only"), refileAllMethod()};
    for (const double margin : {0.02, 0.05, 0.2, 0.5}) {
        policies.push_back(fatMethod(margin, FalsePairs::kKept));
        policies.push_back(fatMethod(margin, FalsePairs::kRefused));
    }
    for (const int period : {2, 4, 8}) {
        policies.push_back(staleMethod(period));
    }
    constexpr double kCellSize = 2;  // [m] the paper's choice: larger than the objects
    policies.push_back(
        paperGridMethod("wiped and hashed again (paper)", kCellSize, FiledCells::kAll));
    policies.push_back(dbvtMethod(false));
    policies.push_back(dbvtMethod(true));
    return policies;
}

Findings measurePolicies(const UpdatePlan& plan, std::span<const PairMethod> policies,
                         std::uint64_t seed, const TellProgress& tell) {
    Results results{plan, policies, {}, settingsText(plan)};
    PairChecks checks;
    for (const Motion& motion : plan.motions) {
        tell(static_cast<double>(results.motions.size()) / static_cast<double>(plan.motions.size()),
             motion.name());
        results.motions.push_back({motion, measureMotion(plan, policies, motion, seed)});
        checks.take(policies, results.motions.back().trial);
    }
    Findings findings;
    findings.settings = {
        results.settings,
        "True pairs: a sweep along one axis in every judged frame, by boxes as they are then; "
        "brute "
        "force judges the sweep.",
        "Moved only: setAabb for all, of which unchanged ones cost a comparison, and what has not "
        "moved for eight frames rests in a table that is left alone."};
    findings.checks = checks.checks();
    findings.checks.push_back(stillnessCheck(results));
    findings.charts = {breakEvenChart(results), errorChart(results, true),
                       errorChart(results, false)};
    addChoices(results, findings.choices);
    for (std::string& sentence :
         std::vector{breakEvenSentence(results, "moved only", "all filed again"),
                     breakEvenSentence(results, "moved only", dbvtMethod(false).name),
                     fastestSentence(results)}) {
        if (!sentence.empty()) {
            findings.conclusions.push_back(std::move(sentence));
        }
    }
    for (const MotionResult& at : results.motions) {
        if (at.motion.share == 1) {
            findings.tables.push_back(resultTable(results, {&at, 1}));
            findings.charts.push_back(errorBars(results, at, true));
            findings.charts.push_back(errorBars(results, at, false));
            findings.conclusions.push_back(errorSentence(results, at));
        }
    }
    return findings;
}

Experiment updateExperiment() {
    return {"P10",
            "Update policy",
            "What does it save not to tell the broadphase of every move, and what goes wrong?",
            4,
            40,
            [](const Effort& effort, const TellProgress& tell) {
                return measurePolicies(updatePlan(effort), updatePolicies(), effort.seed, tell);
            }};
}

}  // namespace hashphase::demos
