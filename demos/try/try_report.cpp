// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;
using tryout::StepRow;

std::vector<StepRow> rowsOf(const Trial& trial, Broadphase broadphase) {
    std::vector<StepRow> rows;
    for (const TriedRun& run : trial.runs) {
        if (run.broadphase == broadphase) {
            rows.insert(rows.end(), run.rows.begin(), run.rows.end());
        }
    }
    return rows;
}

template <class Number>
double median(const std::vector<StepRow>& rows, Number StepRow::*field) {
    std::vector<double> series;
    for (const StepRow& row : rows) {
        series.push_back(static_cast<double>(row.*field));
    }
    return spreadOf(std::move(series)).median;
}

template <class Number>
double mean(const std::vector<StepRow>& rows, Number StepRow::*field) {
    double sum = 0;
    for (const StepRow& row : rows) {
        sum += static_cast<double>(row.*field);
    }
    return sum / static_cast<double>(rows.size());
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

// --- Text ----------------------------------------------------------------------------------------

std::string ms(double number) {
    return milliseconds(number);
}

std::string count(double number) {
    return number < 100 && number != std::floor(number)
               ? fixed(number, 1)
               : withThousands(static_cast<std::uint64_t>(std::llround(number)));
}

std::string percent(double share) {
    return fixed(100 * share, share < 0.1 ? 1 : 0) + " %";
}

std::string times(double ratio) {
    return fixed(ratio, ratio < 10 ? 2 : 1) + "x";
}

std::string orDash(const std::optional<double>& number, std::string (*text)(double)) {
    return number ? text(*number) : "-";
}

std::string headOf(const Trial& trial) {
    const TriedRun& run = trial.runs.front();
    std::string text = trial.commandLine + ": ";
    const auto part = [&](std::uint32_t number, const std::string& name) {
        if (number > 0) {
            text += withThousands(number) + " " + name + (number > 1 ? "s" : "") + ", ";
        }
    };
    part(run.dbvtCount, "btDbvtBroadphase");
    part(run.axisSweepCount, "axis sweep");
    text += trial.program.precision == BulletPrecision::kSingle ? "single" : "double";
    return text + " precision" + (trial.program.bullet.empty() ? "" : ", " + trial.program.bullet);
}

void printNotes(const Trial& trial, std::ostream& out) {
    const TriedRun& first = trial.runs.front();
    for (const TriedRun& run : trial.runs) {
        if (run.end != first.end) {
            out << "The program " << textOf(first.end) << " with Bullet's broadphase, and "
                << textOf(run.end) << " with hashphase.\n";
            break;
        }
        if (run.end.isCrash) {
            out << "The program " << textOf(run.end)
                << (trial.runs.size() > 1 ? ", whichever the broadphase.\n" : ".\n");
            break;
        }
    }
    if (first.foreignCalculations > 0) {
        out << withThousands(first.foreignCalculations)
            << " calculations of pairs were those of broadphases that are not taken over.\n";
    }
    if (first.otherProcesses > 0) {
        out << withThousands(first.otherProcesses)
            << " further processes had broadphases of their own, which are not in these figures.\n";
    }
}

void printVerified(const Trial& trial, const TriedRun& run, std::ostream& out) {
    Table table({"pairs", "right", "missing", "extra"});
    table.addRow({"hashphase", withThousands(run.pairs - run.extra), withThousands(run.missing),
                  withThousands(run.extra)});
    table.addRow({"Bullet's", withThousands(run.pairs - run.extra + run.missing - run.stockMissing),
                  withThousands(run.stockMissing), withThousands(run.stockExtra)});
    table.print(out);
    printNotes(trial, out);
    if (run.unasked > 0) {
        out << withThousands(run.unasked)
            << " times a pair was refused that the filter would take now: the filter was changed, "
               "and nothing has moved since. See refilter().\n";
    }
    if (!run.firstFault.empty()) {
        out << "The first fault, " << run.firstFault << ".\n";
    }
    if (run.calculations == 0) {
        out << "Nothing was verified: no pairs were calculated.\n";
        return;
    }
    out << withThousands(run.calculations) << " calculations of pairs verified: the pairs of "
        << "hashphase are " << (run.missing + run.extra == 0 ? "exact in each" : "NOT EXACT")
        << ".\n";
}

void printTable(const StepSummary& stock, const StepSummary& ours, std::ostream& out) {
    Table table({"a step", "Bullet's", "hashphase", "ratio"});
    const auto timeRow = [&](const char* name, double a, double b) {
        table.addRow({name, ms(a), ms(b), b > 0 ? times(a / b) : "-"});
    };
    const auto countRow = [&](const char* name, double a, double b) {
        table.addRow({name, count(a), count(b), ""});
    };
    timeRow("updateAabbs [ms]", stock.updateAabbs, ours.updateAabbs);
    timeRow("calculateOverlappingPairs [ms]", stock.calculate, ours.calculate);
    timeRow("rays, with what they hit [ms]", stock.rays, ours.rays);
    timeRow("these together [ms]", stock.broadphase(), ours.broadphase());
    if (stock.step && ours.step) {
        timeRow("whole step [ms]", *stock.step, *ours.step);
        table.addRow({"share of these", percent(stock.broadphase() / *stock.step),
                      percent(ours.broadphase() / *ours.step), ""});
    }
    countRow("pairs", stock.pairCount, ours.pairCount);
    table.addRow({"of which overlap", orDash(stock.truePairCount, count),
                  orDash(ours.truePairCount, count), ""});
    countRow("rays", stock.rayCount, ours.rayCount);
    countRow("objects at most", stock.objectCount, ours.objectCount);
    countRow("steps", static_cast<double>(stock.stepCount), static_cast<double>(ours.stepCount));
    table.print(out);
}

void printCompared(const Trial& trial, std::ostream& out) {
    const std::optional<StepSummary> stock = summaryOf(trial, Broadphase::stock);
    const std::optional<StepSummary> ours = summaryOf(trial, Broadphase::hash);
    if (stock && ours) {
        printTable(*stock, *ours, out);
    }
    printNotes(trial, out);
    if (!stock || !ours) {
        out << "No step was measured: no pairs were calculated.\n";
        return;
    }
    constexpr std::size_t kFew = 60;
    if (std::min(stock->stepCount, ours->stepCount) < kFew) {
        out << "These are few steps: take the figures as a hint.\n";
    }
    if (const std::optional<double> step = projectedStep(*stock, *ours)) {
        out << "With hashphase a step of " << ms(*stock->step) << " ms takes " << ms(*step)
            << " ms, all else being equal (" << times(*stock->step / *step) << "); measured, "
            << ms(*ours->step) << " ms (" << times(*stock->step / *ours->step) << ").\n";
    } else {
        out << "How long a step is as a whole Bullet's profile zones do not tell.\n";
    }
}

// --- JSON ----------------------------------------------------------------------------------------

const char* jsonName(Broadphase broadphase) {
    return broadphase == Broadphase::stock  ? "bullet"
           : broadphase == Broadphase::hash ? "hashphase"
                                            : "verified";
}

Json runJson(const TriedRun& run) {
    Json rows = Json::array();
    for (const StepRow& row : run.rows) {
        rows.push_back({{"stepMs", row.step > 0 ? Json(row.step) : Json(nullptr)},
                        {"updateAabbsMs", row.updateAabbs},
                        {"calculateMs", row.calculate},
                        {"raysMs", row.rays},
                        {"rays", row.rayCount},
                        {"objects", row.objectCount},
                        {"pairs", row.pairCount},
                        {"overlappingPairs", row.truePairCount != StepRow::kNotCounted
                                                 ? Json(row.truePairCount)
                                                 : Json(nullptr)}});
    }
    return {{"broadphase", jsonName(run.broadphase)},
            {"ended", textOf(run.end)},
            {"dbvts", run.dbvtCount},
            {"axisSweeps", run.axisSweepCount},
            {"foreignCalculations", run.foreignCalculations},
            {"otherProcesses", run.otherProcesses},
            {"steps", std::move(rows)}};
}

Json summaryJson(const std::optional<StepSummary>& summary) {
    if (!summary) {
        return nullptr;
    }
    return {{"steps", summary->stepCount},
            {"updateAabbsMs", summary->updateAabbs},
            {"calculateMs", summary->calculate},
            {"raysMs", summary->rays},
            {"stepMs", orNull(summary->step)},
            {"rays", summary->rayCount},
            {"objects", summary->objectCount},
            {"pairs", summary->pairCount},
            {"overlappingPairs", orNull(summary->truePairCount)}};
}

Json verifiedJson(const TriedRun& run) {
    if (run.broadphase != Broadphase::verifying) {
        return nullptr;
    }
    return {{"calculations", run.calculations}, {"pairs", run.pairs},
            {"missing", run.missing},           {"extra", run.extra},
            {"waitForAMove", run.unasked},      {"bulletMissing", run.stockMissing},
            {"bulletExtra", run.stockExtra},    {"firstFault", orNull(run.firstFault)}};
}

}  // namespace

std::optional<StepSummary> summaryOf(const Trial& trial, Broadphase broadphase) {
    const std::vector<StepRow> rows = rowsOf(trial, broadphase);
    if (rows.empty()) {
        return std::nullopt;
    }
    StepSummary summary;
    summary.stepCount = rows.size();
    summary.updateAabbs = median(rows, &StepRow::updateAabbs);
    summary.calculate = median(rows, &StepRow::calculate);
    summary.rays = median(rows, &StepRow::rays);
    if (const double step = median(rows, &StepRow::step); step > 0) {
        summary.step = step;
    }
    summary.rayCount = mean(rows, &StepRow::rayCount);
    for (const StepRow& row : rows) {
        summary.objectCount = std::max(summary.objectCount, static_cast<double>(row.objectCount));
    }
    summary.pairCount = mean(rows, &StepRow::pairCount);
    summary.truePairCount = truePairs(rows, summary.pairCount);
    return summary;
}

std::optional<double> projectedStep(const StepSummary& stock, const StepSummary& ours) {
    if (!stock.step) {
        return std::nullopt;
    }
    return std::max(*stock.step - stock.broadphase(), 0.0) + ours.broadphase();
}

void printTrial(const Trial& trial, std::ostream& out) {
    out << headOf(trial) << "\n\n";
    if (trial.runs.front().broadphase == Broadphase::verifying) {
        printVerified(trial, trial.runs.front(), out);
    } else {
        printCompared(trial, out);
    }
}

void writeTrialJson(const Trial& trial, const std::string& commandLine, std::ostream& out) {
    Json json{
        {"format", "hashphase-try"},
        {"version", 1},
        {"provenance", provenanceJson(gatherProvenance(commandLine))},
        {"program", trial.commandLine},
        {"bullet", orNull(trial.program.bullet)},
        {"precision", trial.program.precision == BulletPrecision::kSingle ? "single" : "double"}};
    const std::optional<StepSummary> stock = summaryOf(trial, Broadphase::stock);
    const std::optional<StepSummary> ours = summaryOf(trial, Broadphase::hash);
    json["bulletStep"] = summaryJson(stock);
    json["hashphaseStep"] = summaryJson(ours);
    json["projectedStepMs"] = stock && ours ? orNull(projectedStep(*stock, *ours)) : Json(nullptr);
    json["verification"] = verifiedJson(trial.runs.front());
    for (const TriedRun& run : trial.runs) {
        json["runs"].push_back(runJson(run));
    }
    out << textOf(json);
}

}  // namespace hashphase::demos
