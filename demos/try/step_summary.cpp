// SPDX-License-Identifier: Zlib
#include <demos/try/step_summary.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;
using tryout::StepRow;

template <class Number>
double mean(const std::vector<StepRow>& rows, Number StepRow::*field) {
    double sum = 0;
    for (const StepRow& row : rows) {
        sum += static_cast<double>(row.*field);
    }
    return sum / static_cast<double>(rows.size());
}

float lengthOf(const StepRow& row) {
    return row.step > 0 ? row.step : row.updateAabbs + row.calculate;
}

/// Steps by their length: a twentieth of them on either side is set apart, of few none.
struct SortedSteps {
    std::vector<StepRow> usual;
    std::vector<StepRow> slowest;
};

SortedSteps sortByLength(std::vector<StepRow> rows) {
    constexpr std::ptrdiff_t kShare = 20;
    std::stable_sort(rows.begin(), rows.end(),
                     [](const StepRow& a, const StepRow& b) { return lengthOf(a) < lengthOf(b); });
    const std::ptrdiff_t cut = static_cast<std::ptrdiff_t>(rows.size()) / kShare;
    return {{rows.begin() + cut, rows.end() - cut}, {rows.end() - cut, rows.end()}};
}

double timeOf(const std::vector<StepRow>& rows) {
    return std::accumulate(rows.begin(), rows.end(), 0.0,
                           [](double sum, const StepRow& row) { return sum + lengthOf(row); });
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

StepSummary summaryOf(const std::vector<StepRow>& all) {
    const SortedSteps sorted = sortByLength(all);
    const std::vector<StepRow>& usual = sorted.usual;
    StepSummary summary;
    summary.stepCount = all.size();
    summary.updateAabbs = mean(usual, &StepRow::updateAabbs);
    summary.calculate = mean(usual, &StepRow::calculate);
    summary.rays = mean(usual, &StepRow::rays);
    if (const double step = mean(usual, &StepRow::step); step > 0) {
        summary.step = step;
    }
    summary.raysBetween = mean(usual, &StepRow::raysBetween);
    summary.slowestShare = timeOf(sorted.slowest) / timeOf(all);
    summary.slowest = timeOf(sorted.slowest) / std::max(1.0, double(sorted.slowest.size()));
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
    comparison.stock = summaryOf(stockRows);
    comparison.ours = summaryOf(ourRows);
    return comparison;
}

std::optional<double> projectedStep(const StepSummary& stock, const StepSummary& ours) {
    if (!stock.step) {
        return std::nullopt;
    }
    return *stock.step - stock.broadphase() + ours.broadphase();
}

}  // namespace hashphase::demos
