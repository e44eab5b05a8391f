// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/cell_size_findings.hpp>

#include <demos/accuracy/pairs/cell_size_charts.hpp>
#include <demos/accuracy/pairs/pair_findings.hpp>
#include <demos/console/format.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

/// Where no box is larger than a cell, each spans at most two cells an axis: its corners are all.
Check cornersCheck(std::span<const CellCaseResult> results) {
    std::uint64_t missed = 0;
    std::uint64_t truePairs = 0;
    for (const CellCaseResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            const CellMethod& method = result.methods[i];
            if (!method.pairs.isComplete && method.factor &&
                *method.factor >= result.largestEdgeByMean) {
                missed += result.trial.measurements[i].missed;
                truePairs += result.trial.measurements[i].truePairs;
            }
        }
    }
    return {"The paper's corner cells miss nothing where no box is larger than a cell", missed == 0,
            withThousands(missed) + " of " + withThousands(truePairs)};
}

void addChoices(const CellCaseResult& result, std::vector<Choice>& choices) {
    for (std::size_t i = 0; i < result.methods.size(); ++i) {
        const PairMeasurement& measured = result.trial.measurements[i];
        if (measured.time) {
            choices.push_back({"All pairs of a frame: " + result.name + " boxes",
                               result.methods[i].name(), measured.time->median,
                               missedShare(measured), pairResultText(measured),
                               result.methods[i].pairs.origin == kOurs});
        }
    }
}

std::string regretSentence(std::span<const CellCaseResult> results) {
    std::vector<std::pair<double, std::string>> regrets;
    for (const CellCaseResult& result : results) {
        if (const auto regret = result.regret()) {
            regrets.emplace_back(*regret, result.name);
        }
    }
    std::sort(regrets.begin(), regrets.end());
    if (regrets.empty()) {
        return "No population was timed with automatic and fixed cells.";
    }
    const auto& [worst, where] = regrets.back();
    constexpr double kGoal = 0.15;
    return "Automatic cells against the best fixed ones, " + std::to_string(regrets.size()) +
           " populations: " + fixed(100 * regrets[regrets.size() / 2].first, 0) +
           " % more time in the median, " + fixed(100 * worst, 0) + " % in the worst (" + where +
           "); the goal of at most 15 % is " + (worst <= kGoal ? "met." : "missed there.");
}

/// What the worst of the fixed sizes costs, and what the paper's one grid does with such boxes.
std::string worstSentence(std::span<const CellCaseResult> results) {
    double worstRatio = 0;
    std::string where;
    for (const CellCaseResult& result : results) {
        const auto best = result.bestFixed();
        for (std::size_t i = 0; best && i < result.methods.size(); ++i) {
            const auto time = result.nanosecondsOf(i);
            const double ratio = time ? *time / *result.nanosecondsOf(*best) : 0;
            if (result.methods[i].isFixed() && ratio > worstRatio) {
                worstRatio = ratio;
                where = result.name + ", cells of " + factorText(*result.methods[i].factor) +
                        " mean edges";
            }
        }
    }
    return "The worst fixed cell size takes " + fixed(worstRatio, 1) +
           " times as long as the best one (" + where + ").";
}

std::string paperSentence(const CellCaseResult& result) {
    double mostMissed = 0;
    double fewestNanoseconds = 0;
    std::uint64_t timedWays = 0;
    for (std::size_t i = 0; i < result.methods.size(); ++i) {
        const CellMethod& method = result.methods[i];
        if (method.pairs.origin != kOfPaper) {
            continue;
        }
        const auto time = result.nanosecondsOf(i);
        if (method.pairs.isExact && time && (timedWays++ == 0 || *time < fewestNanoseconds)) {
            fewestNanoseconds = *time;
        }
        mostMissed = std::max(mostMissed, missedShare(result.trial.measurements[i]));
    }
    const auto ours = result.automatic();
    if (timedWays == 0 || !ours) {
        return {};
    }
    return "One grid as in the paper, " + result.name + ": at its best cell size it takes " +
           fixed(fewestNanoseconds / *result.nanosecondsOf(*ours), 1) +
           " times as long as automatic levels; filed by corners as printed, it misses up to " +
           percentText(mostMissed) + " of the pairs.";
}

std::string bulletSentence(const CellCaseResult& result) {
    const auto ours = result.automatic();
    const auto bullet = result.bullet();
    if (!ours || !bullet) {
        return {};
    }
    return "btDbvtBroadphase, " + result.name + ": " +
           fixed(*result.nanosecondsOf(*bullet) / *result.nanosecondsOf(*ours), 1) +
           " times as long as automatic levels, and " +
           pairResultText(result.trial.measurements[*bullet]) + ".";
}

bool hasOthers(const CellCaseResult& result) {
    return std::any_of(result.methods.begin(), result.methods.end(), [](const CellMethod& each) {
        return each.pairs.origin != kOurs;
    });
}

/// Of each population the largest case that has all methods.
std::vector<const CellCaseResult*> showcases(std::span<const CellCaseResult> results) {
    std::vector<const CellCaseResult*> chosen;
    for (const CellCaseResult& result : results) {
        if (!hasOthers(result)) {
            continue;
        }
        const auto known = std::find_if(chosen.begin(), chosen.end(), [&](const auto* each) {
            return each->population == result.population;
        });
        if (known == chosen.end()) {
            chosen.push_back(&result);
        } else if (result.objects > (*known)->objects) {
            *known = &result;
        }
    }
    return chosen;
}

}  // namespace

Findings cellSizeFindings(std::span<const CellCaseResult> results) {
    Findings findings;
    findings.settings = {
        cellSizeSettings(),
        "True pairs: a sweep along one axis, which brute force judges up to 20,000 objects.",
        "Levels: hashphase with finest cells of that size and coarser ones of 4, 16 ... times, of "
        "which a box lies on the finest with cells no smaller than it; where most boxes are a "
        "little smaller than the cells of one level, all of them share it. "
        "Automatic: sizes chosen from the population. One grid: the paper's, with one size for "
        "all.",
        "Not measured: the paper's grids where an object would lie in more than 64 cells on "
        "average, and their times where a frame compares more than 300 boxes an object; they "
        "and btDbvtBroadphase above 20,000 objects."};
    PairChecks checks;
    for (const CellCaseResult& result : results) {
        std::vector<PairMethod> methods;
        for (const CellMethod& each : result.methods) {
            methods.push_back(each.pairs);
        }
        checks.take(methods, result.trial);
    }
    findings.checks = checks.checks();
    findings.checks.push_back(cornersCheck(results));
    findings.charts = overviewCharts(results);
    findings.tables = {regretTable(results)};
    findings.conclusions = {regretSentence(results), worstSentence(results)};
    for (const CellCaseResult* result : showcases(results)) {
        for (Chart& chart : caseCharts(*result)) {
            findings.charts.push_back(std::move(chart));
        }
        addChoices(*result, findings.choices);
        for (std::string& sentence : std::vector{paperSentence(*result), bulletSentence(*result)}) {
            if (!sentence.empty()) {
                findings.conclusions.push_back(std::move(sentence));
            }
        }
    }
    return findings;
}

}  // namespace hashphase::demos
