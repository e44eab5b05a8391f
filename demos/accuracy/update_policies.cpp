// SPDX-License-Identifier: Zlib
#include <demos/accuracy/update_policies.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/pair_findings.hpp>
#include <demos/accuracy/paper_grid.hpp>
#include <demos/accuracy/update_policy.hpp>
#include <demos/console/format.hpp>
#include <demos/scenes/scatter.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

/// What was measured where that share of the boxes moves.
struct SharedResult {
    double movingShare;
    PairTrial trial;
};

struct Results {
    const UpdatePlan& plan;
    std::span<const PairMethod> policies;
    std::vector<SharedResult> shares;
    std::string settings;

    [[nodiscard]] double nanoseconds(const SharedResult& at, std::size_t policy) const {
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
    [[nodiscard]] std::optional<double> bulletNanoseconds(const SharedResult& at) const {
        const auto bullet = find(dbvtMethod(false).name);
        return bullet ? std::optional(nanoseconds(at, *bullet)) : std::nullopt;
    }
};

PairTrial measureShare(const UpdatePlan& plan, std::span<const PairMethod> policies,
                       double movingShare, std::uint64_t seed) {
    ScatterPlan scatterPlan;
    scatterPlan.movingShare = static_cast<float>(movingShare);
    scatterPlan.step = static_cast<float>(plan.step);
    BrownianScene scene(scatter(scatterPlan, plan.objects, seed), seed);
    PairTrialPlan trialPlan;
    trialPlan.judgedFrames = plan.judgedFrames;
    trialPlan.rounds = plan.rounds;
    trialPlan.framesTogether = plan.framesTogether;
    return tryPairs(scene, policies, trialPlan);
}

DataTable resultTable(const Results& results, std::span<const SharedResult> shares) {
    DataTable table{pairColumns(), {}};
    table.columns.insert(table.columns.begin(),
                         {{"policy", "policy"}, {"moving_percent", "boxes that move [%]"}});
    for (const SharedResult& at : shares) {
        for (std::size_t i = 0; i < results.policies.size(); ++i) {
            std::vector<Value> row =
                pairValues(at.trial.measurements[i], results.nanoseconds(at, i),
                           results.bulletNanoseconds(at));
            row.insert(row.begin(), {results.policies[i].name, 100 * at.movingShare});
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
    chart.data = resultTable(results, results.shares);
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
    chart.data = resultTable(results, results.shares);
    chart.x = {"ns", AxisScale::kLog};
    chart.y = {isMissed ? "missed_share" : "false_share", AxisScale::kLogAndZero};
    chart.series = "policy";
    chart.label = "moving_percent";
    chart.showFront = true;
    if (isMissed) {
        chart.low = "missed_low";
        chart.high = "missed_high";
    }
    return chart;
}

Chart errorBars(const Results& results, bool isMissed) {
    const SharedResult& busiest = results.shares.back();
    Chart chart = errorChart(results, isMissed);
    chart.name += "-by-policy";
    chart.title = std::string(isMissed ? "Missed" : "False") + " pairs by policy, where " +
                  percentText(busiest.movingShare) + " of the boxes move";
    chart.mark = ChartMark::kBar;
    chart.data = resultTable(results, {&busiest, 1});
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
    for (const SharedResult& at : results.shares) {
        for (const PairMeasurement& each : at.trial.measurements) {
            if (at.movingShare == 0) {
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
    return policy.origin == MethodOrigin::kOurs && policy.missesNothing && !policy.isExact;
}

void addChoices(const Results& results, std::vector<Choice>& choices) {
    for (const SharedResult& at : results.shares) {
        if (at.movingShare != 1 && at.movingShare != 0.05) {
            continue;
        }
        const std::string task = "Pairs of " + withThousands(results.plan.objects) + " boxes, " +
                                 (at.movingShare == 1 ? "all" : percentText(at.movingShare)) +
                                 " moving";
        for (std::size_t i = 0; i < results.policies.size(); ++i) {
            const PairMeasurement& measured = at.trial.measurements[i];
            if (isUnfinished(results.policies[i])) {
                continue;
            }
            choices.push_back({task, results.policies[i].name, measured.time->median,
                               missedShare(measured), pairResultText(measured),
                               results.policies[i].origin == MethodOrigin::kOurs});
        }
    }
}

/// Up to which share of moving boxes `policy` is faster than `other`.
std::string breakEvenSentence(const Results& results, std::string_view policy,
                              std::string_view other) {
    const auto a = results.find(policy);
    const auto b = results.find(other);
    if (!a || !b) {
        return {};
    }
    std::string faster;
    std::string slower;
    for (const SharedResult& at : results.shares) {
        const double ratio = results.nanoseconds(at, *b) / results.nanoseconds(at, *a);
        std::string& list = ratio >= 1 ? faster : slower;
        list += (list.empty() ? "" : ", ") + percentText(at.movingShare) + " (" +
                fixed(ratio, ratio < 10 ? 2 : 0) + "x)";
    }
    return "'" + std::string(policy) + "' against '" + std::string(other) + "': faster where " +
           (faster.empty() ? "nothing" : faster) + " of the boxes move; slower at " +
           (slower.empty() ? "none of the shares" : slower) + ".";
}

std::string errorSentence(const Results& results) {
    const SharedResult& busiest = results.shares.back();
    std::string text = "Where " + percentText(busiest.movingShare) + " of the boxes move:";
    for (std::size_t i = 0; i < results.policies.size(); ++i) {
        const PairMeasurement& measured = busiest.trial.measurements[i];
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
           "so by up to " +
           valueText(100 * plan.step) +
           " cm on each axis and frame. A frame is the calls of setAabb and all pairs, the pair "
           "cache included (the paper's grid keeps none); means of " +
           std::to_string(plan.framesTogether) + " frames in a row, medians of " +
           std::to_string(plan.rounds) + " such means.";
}

}  // namespace

UpdatePlan updatePlan(const Effort& effort) {
    UpdatePlan plan;
    plan.objects = effort.quickOrFull<std::size_t>(2'000, 10'000);
    plan.movingShares = effort.isQuick ? std::vector{0.0, 0.05, 0.5, 1.0}
                                       : std::vector{0.0, 0.01, 0.05, 0.2, 0.5, 1.0};
    plan.judgedFrames = effort.quickOrFull(8, 16);
    plan.rounds = effort.quickOrFull(16, 20);
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
    for (const double share : plan.movingShares) {
        tell(static_cast<double>(results.shares.size()) /
                 static_cast<double>(plan.movingShares.size()),
             percentText(share) + " of the boxes move");
        results.shares.push_back({share, measureShare(plan, policies, share, seed)});
        checks.take(policies, results.shares.back().trial);
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
                       errorChart(results, false), errorBars(results, true),
                       errorBars(results, false)};
    findings.tables = {resultTable(results, {&results.shares.back(), 1})};
    addChoices(results, findings.choices);
    for (std::string& sentence :
         std::vector{breakEvenSentence(results, "moved only", "all filed again"),
                     breakEvenSentence(results, "fat by 5 cm, pairs tested", "moved only"),
                     breakEvenSentence(results, "moved only", dbvtMethod(true).name),
                     errorSentence(results)}) {
        if (!sentence.empty()) {
            findings.conclusions.push_back(std::move(sentence));
        }
    }
    return findings;
}

Experiment updateExperiment() {
    return {"P10",
            "Update policy",
            "What does it save not to tell the broadphase of every move, and what goes wrong?",
            5,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                return measurePolicies(updatePlan(effort), updatePolicies(), effort.seed, tell);
            }};
}

}  // namespace hashphase::demos
