// SPDX-License-Identifier: Zlib
#include <demos/try/step_summary.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>

namespace hashphase::demos {
namespace {

using tryout::StepRow;
using tryout::Times;
using Rows = std::vector<StepRow>;

template <class Of>
double sumOf(const Rows& rows, const Of& of) {
    double sum = 0;
    for (const StepRow& row : rows) {
        sum += static_cast<double>(std::invoke(of, row));
    }
    return sum;
}

template <class Of>
double meanOf(const Rows& rows, const Of& of) {
    return sumOf(rows, of) / static_cast<double>(rows.size());
}

auto timeOf(Times StepRow::*part, float Times::*clock) {
    return [part, clock](const StepRow& row) { return row.*part.*clock; };
}

auto lengthBy(float Times::*clock) {
    return [clock](const StepRow& row) {
        return row.isStep != 0 ? row.step.*clock : row.updateAabbs.*clock + row.calculate.*clock;
    };
}

// Without a look at the clock itself, which is not in the time on the wall: that is shorter then.
double processorTime(const Rows& rows, Times StepRow::*part) {
    constexpr double kLook = 0.002;
    const double processor = meanOf(rows, timeOf(part, &Times::processor));
    return std::clamp(meanOf(rows, timeOf(part, &Times::wall)), std::max(0.0, processor - kLook),
                      processor);
}

bool hasSteps(const Rows& rows) {
    return rows.front().isStep != 0;
}

// Where a step is on threads, in what waits for none of them.
double processorShare(const Rows& rows, bool onThreads) {
    const auto time = [&](float Times::*clock) {
        return hasSteps(rows) && !onThreads ? sumOf(rows, timeOf(&StepRow::step, clock))
                                            : sumOf(rows, timeOf(&StepRow::updateAabbs, clock)) +
                                                  sumOf(rows, timeOf(&StepRow::calculate, clock));
    };
    const double wall = time(&Times::wall);
    return wall > 0 ? std::min(1.0, time(&Times::processor) / wall) : 1;
}

// The share of pairs that overlap in the steps that were looked at, of all pairs.
std::optional<double> truePairs(const Rows& all, double pairCount) {
    Rows rows = all;
    std::erase_if(rows,
                  [](const StepRow& row) { return row.truePairCount == StepRow::kNotCounted; });
    const double pairs = sumOf(rows, &StepRow::pairCount);
    if (pairs == 0) {
        return pairCount == 0 ? std::optional(0.0) : std::nullopt;
    }
    return pairCount * sumOf(rows, &StepRow::truePairCount) / pairs;
}

}  // namespace

bool isOnThreads(const Rows& rows) {
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

StepSummary summaryOf(const Rows& all, bool onThreads) {
    const auto clock = onThreads ? &Times::wall : &Times::processor;
    // By their length a twentieth of the steps on either side is set apart, of few none.
    Rows sorted = all;
    std::ranges::stable_sort(sorted, {}, lengthBy(clock));
    const auto cut = static_cast<std::ptrdiff_t>(sorted.size()) / 20;
    const Rows usual(sorted.begin() + cut, sorted.end() - cut);
    const Rows slowest(sorted.end() - cut, sorted.end());
    const auto wholeTime = [&](Times StepRow::*part) {
        return onThreads ? meanOf(usual, timeOf(part, clock)) : processorTime(usual, part);
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
    summary.stepOnWall = meanOf(usual, timeOf(&StepRow::step, &Times::wall));
    summary.processorShare = processorShare(onThreads ? all : usual, onThreads);
    const double shareOfRays = onThreads ? 1 : summary.processorShare;
    summary.rays = meanOf(usual, &StepRow::rays) * shareOfRays;
    summary.raysBetween = meanOf(usual, &StepRow::raysBetween) * shareOfRays;
    const double time = sumOf(all, lengthBy(clock));
    const double timeOfSlowest = sumOf(slowest, lengthBy(clock));
    summary.slowestShare = time > 0 ? timeOfSlowest / time : 0;
    summary.slowest = timeOfSlowest / std::max(1.0, static_cast<double>(slowest.size()));
    summary.rayCount = meanOf(all, &StepRow::rayCount);
    summary.rayBetweenCount = meanOf(all, &StepRow::rayBetweenCount);
    summary.objectCount = std::ranges::max(all, {}, &StepRow::objectCount).objectCount;
    summary.pairCount = sumOf(all, &StepRow::pairCount) / sumOf(all, &StepRow::calculations);
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
    const std::vector<const TriedRun*> stock = runsOf(trial, tryout::Broadphase::stock);
    const std::vector<const TriedRun*> ours = runsOf(trial, tryout::Broadphase::hash);
    Rows stockRows;
    Rows ourRows;
    StepComparison comparison;
    for (std::size_t i = 0; i < std::min(stock.size(), ours.size()); ++i) {
        const Rows& a = stock[i]->rows;
        const Rows& b = ours[i]->rows;
        comparison.isCut |= a.size() != b.size();
        comparison.allOfStock += a.size();
        comparison.allOfOurs += b.size();
        const auto count = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
        stockRows.insert(stockRows.end(), a.begin(), a.begin() + count);
        ourRows.insert(ourRows.end(), b.begin(), b.begin() + count);
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
    return stock.step ? std::optional(*stock.step - stock.broadphase() + ours.broadphase())
                      : std::nullopt;
}

}  // namespace hashphase::demos
