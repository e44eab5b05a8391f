// SPDX-License-Identifier: Zlib
#include <demos/try/step_summary.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;
using tryout::StepRow;
using tryout::Times;

template <class Number>
double mean(const std::vector<StepRow>& rows, Number StepRow::*field) {
    double sum = 0;
    for (const StepRow& row : rows) {
        sum += static_cast<double>(row.*field);
    }
    return sum / static_cast<double>(rows.size());
}

double meanTime(const std::vector<StepRow>& rows, Times StepRow::*part, float Times::*clock) {
    double sum = 0;
    for (const StepRow& row : rows) {
        sum += static_cast<double>(row.*part.*clock);
    }
    return sum / static_cast<double>(rows.size());
}

// Without a look at the clock itself, which is not in the time on the wall: that is shorter then.
double processorTime(const std::vector<StepRow>& rows, Times StepRow::*part) {
    constexpr double kLook = 0.002;
    const double processor = meanTime(rows, part, &Times::processor);
    return std::clamp(meanTime(rows, part, &Times::wall), std::max(0.0, processor - kLook),
                      processor);
}

bool hasSteps(const std::vector<StepRow>& rows) {
    return rows.front().isStep != 0;
}

float lengthOf(const StepRow& row, float Times::*clock) {
    return row.isStep != 0 ? row.step.*clock : row.updateAabbs.*clock + row.calculate.*clock;
}

/// Steps by their length: a twentieth of them on either side is set apart, of few none.
struct SortedSteps {
    std::vector<StepRow> usual;
    std::vector<StepRow> slowest;
};

SortedSteps sortByLength(std::vector<StepRow> rows, float Times::*clock) {
    constexpr std::ptrdiff_t kShare = 20;
    std::stable_sort(rows.begin(), rows.end(), [clock](const StepRow& a, const StepRow& b) {
        return lengthOf(a, clock) < lengthOf(b, clock);
    });
    const std::ptrdiff_t cut = static_cast<std::ptrdiff_t>(rows.size()) / kShare;
    return {{rows.begin() + cut, rows.end() - cut}, {rows.end() - cut, rows.end()}};
}

double timeOf(const std::vector<StepRow>& rows, float Times::*clock) {
    return std::accumulate(rows.begin(), rows.end(), 0.0, [clock](double sum, const StepRow& row) {
        return sum + lengthOf(row, clock);
    });
}

// Where a step is on threads, in what waits for none of them.
double processorShare(const std::vector<StepRow>& rows, bool onThreads) {
    const auto time = [&](float Times::*clock) {
        return hasSteps(rows) && !onThreads ? meanTime(rows, &StepRow::step, clock)
                                            : meanTime(rows, &StepRow::updateAabbs, clock) +
                                                  meanTime(rows, &StepRow::calculate, clock);
    };
    const double wall = time(&Times::wall);
    return wall > 0 ? std::min(1.0, time(&Times::processor) / wall) : 1;
}

// Of a calculation, on average.
double meanPairs(const std::vector<StepRow>& rows) {
    double calculations = 0;
    double pairs = 0;
    for (const StepRow& row : rows) {
        calculations += row.calculations;
        pairs += row.pairCount;
    }
    return pairs / calculations;
}

// The share of pairs that overlap in the steps that were looked at, of all pairs.
std::optional<double> truePairs(const std::vector<StepRow>& rows, double pairCount) {
    double all = 0;
    double overlapping = 0;
    for (const StepRow& row : rows) {
        if (row.truePairCount != StepRow::kNotCounted) {
            all += row.pairCount;
            overlapping += row.truePairCount;
        }
    }
    if (all == 0) {
        return pairCount == 0 ? std::optional(0.0) : std::nullopt;
    }
    return pairCount * overlapping / all;
}

}  // namespace

bool isOnThreads(const std::vector<StepRow>& rows) {
    constexpr double kShareOfOthers = 0.1;
    constexpr double kLook = 0.02;  // [ms], at the clock itself, the first time
    double own = 0;
    double others = 0;
    for (const StepRow& row : rows) {
        if (row.allProcessor != StepRow::kNotTaken) {
            own += row.step.processor;
            others += row.allProcessor - row.step.processor - kLook;
        }
    }
    return others > kShareOfOthers * own;
}

std::optional<double> StepSummary::stalePairCount() const {
    return truePairCount ? std::optional(std::max(0.0, pairCount - *truePairCount)) : std::nullopt;
}

StepSummary summaryOf(const std::vector<StepRow>& all, bool onThreads) {
    const auto clock = onThreads ? &Times::wall : &Times::processor;
    const SortedSteps sorted = sortByLength(all, clock);
    const std::vector<StepRow>& usual = sorted.usual;
    const auto wholeTime = [&](Times StepRow::*part) {
        return onThreads ? meanTime(usual, part, clock) : processorTime(usual, part);
    };
    StepSummary summary;
    summary.stepCount = all.size();
    summary.updateAabbs = processorTime(usual, &StepRow::updateAabbs);
    summary.calculate = processorTime(usual, &StepRow::calculate);
    if (const double time = wholeTime(&StepRow::narrowPhase); time > 0) {
        summary.narrowPhase = time;
    }
    if (hasSteps(usual)) {
        summary.step = wholeTime(&StepRow::step);
    }
    summary.stepOnWall = meanTime(usual, &StepRow::step, &Times::wall);
    summary.processorShare = processorShare(onThreads ? all : usual, onThreads);
    const double shareOfRays = onThreads ? 1 : summary.processorShare;
    summary.rays = mean(usual, &StepRow::rays) * shareOfRays;
    summary.raysBetween = mean(usual, &StepRow::raysBetween) * shareOfRays;
    const double time = timeOf(all, clock);
    summary.slowestShare = time > 0 ? timeOf(sorted.slowest, clock) / time : 0;
    summary.slowest =
        timeOf(sorted.slowest, clock) / std::max(1.0, static_cast<double>(sorted.slowest.size()));
    summary.rayCount = mean(all, &StepRow::rayCount);
    summary.rayBetweenCount = mean(all, &StepRow::rayBetweenCount);
    for (const StepRow& row : all) {
        summary.objectCount = std::max(summary.objectCount, static_cast<double>(row.objectCount));
    }
    summary.pairCount = meanPairs(all);
    summary.truePairCount = truePairs(all, summary.pairCount);
    return summary;
}

std::vector<const TriedRun*> runsOf(const Trial& trial, tryout::Broadphase broadphase) {
    std::vector<const TriedRun*> runs;
    for (const TriedRun& run : trial.runs) {
        if (run.broadphase == broadphase) {
            runs.push_back(&run);
        }
    }
    return runs;
}

std::optional<StepComparison> compareSteps(const Trial& trial) {
    const std::vector<const TriedRun*> stock = runsOf(trial, Broadphase::stock);
    const std::vector<const TriedRun*> ours = runsOf(trial, Broadphase::hash);
    std::vector<StepRow> stockRows;
    std::vector<StepRow> ourRows;
    StepComparison comparison;
    for (std::size_t i = 0; i < std::min(stock.size(), ours.size()); ++i) {
        const std::size_t count = std::min(stock[i]->rows.size(), ours[i]->rows.size());
        comparison.isCut |= stock[i]->rows.size() != ours[i]->rows.size();
        comparison.allOfStock += stock[i]->rows.size();
        comparison.allOfOurs += ours[i]->rows.size();
        const auto end = static_cast<std::ptrdiff_t>(count);
        stockRows.insert(stockRows.end(), stock[i]->rows.begin(), stock[i]->rows.begin() + end);
        ourRows.insert(ourRows.end(), ours[i]->rows.begin(), ours[i]->rows.begin() + end);
    }
    if (stockRows.empty()) {
        return std::nullopt;
    }
    comparison.onThreads = isOnThreads(stockRows) || isOnThreads(ourRows);
    comparison.stock = summaryOf(stockRows, comparison.onThreads);
    comparison.ours = summaryOf(ourRows, comparison.onThreads);
    return comparison;
}

std::optional<double> projectedStep(const StepSummary& stock, const StepSummary& ours) {
    if (!stock.step) {
        return std::nullopt;
    }
    return *stock.step - stock.broadphase() + ours.broadphase();
}

}  // namespace hashphase::demos
