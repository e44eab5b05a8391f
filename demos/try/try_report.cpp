// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/json_values.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;
using tryout::StepRow;

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
    if (run.derivedSweepCount > 0) {
        text += withThousands(run.derivedSweepCount) +
                " of classes derived from an axis sweep, not taken over, ";
    }
    return text + nameOf(trial.program.precision) + " precision" +
           (trial.program.bullet.empty() ? "" : ", " + trial.program.bullet);
}

// "ended with status 0" or, of several runs that ended differently, all their ends.
std::string endsOf(const Trial& trial, Broadphase broadphase) {
    std::set<std::string> ends;
    for (const TriedRun* run : runsOf(trial, broadphase)) {
        ends.insert(textOf(run->end));
    }
    std::string text;
    for (const std::string& end : ends) {
        text += (text.empty() ? "" : " or ") + end;
    }
    return text;
}

// A run that was ended by a signal or with a status that is not 0, but for those that we have stopped.
const TriedRun* findFailure(const std::vector<const TriedRun*>& runs) {
    const auto failure = std::ranges::find_if(runs, [](const TriedRun* run) {
        return !run->end.isStopped && (run->end.isCrash || run->end.code != 0);
    });
    return failure != runs.end() ? *failure : nullptr;
}

void printEnds(const Trial& trial, std::ostream& out) {
    const TriedRun* stock = findFailure(runsOf(trial, Broadphase::stock));
    const TriedRun* ours = findFailure(runsOf(trial, Broadphase::hash));
    const TriedRun* verified = findFailure(runsOf(trial, Broadphase::verifying));
    const std::string endsOfStock = endsOf(trial, Broadphase::stock);
    const std::string endsOfOurs = endsOf(trial, Broadphase::hash);
    const bool hasFailures = stock != nullptr || ours != nullptr;
    if (isEndOfOurs(trial) || (hasFailures && endsOfStock != endsOfOurs)) {
        out << "The program " << endsOfStock << " with Bullet's broadphase"
            << (endsOfOurs.empty() ? "" : ", and " + endsOfOurs + " with hashphase") << ".\n";
    } else if (stock != nullptr) {
        out << "The program " << textOf(stock->end) << ", whichever the broadphase.\n";
    } else if (verified != nullptr) {
        out << "The program " << textOf(verified->end) << ".\n";
    }
}

void printNotes(const Trial& trial, std::ostream& out) {
    const auto most = [&trial](std::uint32_t TriedRun::*count) {
        std::uint32_t number = 0;
        for (const TriedRun& run : trial.runs) {
            number = std::max(number, run.*count);
        }
        return number;
    };
    printEnds(trial, out);
    if (const std::uint32_t number = most(&TriedRun::foreignCalculations); number > 0) {
        out << withThousands(number)
            << " calculations of pairs were those of broadphases that are not taken over.\n";
    }
    if (const std::uint32_t number = most(&TriedRun::otherProcesses); number > 0) {
        out << withThousands(number) << (number > 1 ? " further processes" : " further process")
            << " had a broadphase or went on with a copy, and " << (number > 1 ? "are" : "is")
            << " not in these figures.\n";
    }
    if (const std::uint32_t number = most(&TriedRun::droppedRows); number > 0) {
        out << "There is room for " << withThousands(tryout::Record::kMaxRows) << " steps; "
            << withThousands(number) << " more are not in these figures.\n";
    }
    const TriedRun& last = trial.runs.back();
    if (!last.hasBroadphase) {
        out << "Run " << trial.runs.size() << " has made no broadphase, and " << textOf(last.end)
            << ": it was the last.\n";
    }
}

void printVerified(const Trial& trial, const TriedRun& run, std::ostream& out) {
    const tryout::Verification& pairs = run.verification;
    Table table({"pairs", "right", "missing", "extra"});
    table.addRow({"hashphase", withThousands(pairs.pairs - pairs.extra),
                  withThousands(pairs.missing), withThousands(pairs.extra)});
    table.addRow({"Bullet's", withThousands(pairs.stockPairs - pairs.stockExtra),
                  withThousands(pairs.stockMissing), withThousands(pairs.stockExtra)});
    table.print(out);
    printNotes(trial, out);
    if (pairs.unasked > 0) {
        out << withThousands(pairs.unasked)
            << " times a pair was refused that the filter would take now: the filter was changed, "
               "and nothing has moved since. See refilter().\n";
    }
    if (pairs.removed > 0) {
        out << withThousands(pairs.removed)
            << " times a pair was missing that the program had taken out of the cache itself: with "
               "hashphase it comes back when the two meet again, or by refilter().\n";
    }
    if (pairs.late > 0) {
        out << withThousands(pairs.late)
            << " times a pair was not judged, as a callback had moved one of the two while pairs "
               "were calculated: its turn is in the next calculation.\n";
    }
    if (const std::string fault = pairs.firstFault.data(); !fault.empty()) {
        out << "The first fault, " << fault << ".\n";
    }
    if (pairs.calculations == 0) {
        out << "Nothing was verified: no pairs were calculated.\n";
        return;
    }
    out << withThousands(pairs.calculations) << " calculations of pairs verified: the pairs of "
        << "hashphase are " << (pairs.missing + pairs.extra == 0 ? "exact in each" : "NOT EXACT")
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
    if (stock.rayBetweenCount + ours.rayBetweenCount > 0) {
        countRow("rays between steps", stock.rayBetweenCount, ours.rayBetweenCount);
        timeRow("these, with what they hit [ms]", stock.raysBetween, ours.raysBetween);
    }
    countRow("objects at most", stock.objectCount, ours.objectCount);
    countRow("steps", static_cast<double>(stock.stepCount), static_cast<double>(ours.stepCount));
    table.print(out);
}

// Of a trial that was ended in its first run, or whose program does something else each time.
void printNotCompared(const Trial& trial, std::ostream& out) {
    const std::vector<StepRow>& rows = trial.runs.front().rows;
    if (trial.runs.size() > 1 || rows.empty()) {
        out << "No steps were compared: the runs have none in common in which pairs were "
               "calculated.\n";
        return;
    }
    const StepSummary stock = summaryOf(rows);
    out << "There was no run with hashphase. With Bullet's broadphase, " << ms(stock.broadphase())
        << " ms of a step";
    if (stock.step) {
        out << " of " << ms(*stock.step) << " ms";
    }
    out << " were updateAabbs, calculateOverlappingPairs and rays; "
        << withThousands(stock.stepCount) << " steps, " << count(stock.objectCount)
        << " objects at most, " << count(stock.pairCount) << " pairs.\n";
}

void printCompared(const Trial& trial, std::ostream& out) {
    const std::optional<StepComparison> steps = compareSteps(trial);
    if (steps) {
        printTable(steps->stock, steps->ours, out);
    }
    printNotes(trial, out);
    if (!steps) {
        printNotCompared(trial, out);
        return;
    }
    const StepSummary& stock = steps->stock;
    const StepSummary& ours = steps->ours;
    if (steps->isCut) {
        out << "Compared are the first steps, as many as both runs have: with Bullet's broadphase "
               "there were "
            << withThousands(steps->allOfStock) << ", with hashphase "
            << withThousands(steps->allOfOurs) << ".\n";
    }
    constexpr double kLargeShare = 0.2;
    if (std::max(stock.slowestShare, ours.slowestShare) > kLargeShare) {
        out << "Times are without the slowest twentieth of the steps, which took "
            << percent(stock.slowestShare) << " of all time with Bullet's and "
            << percent(ours.slowestShare) << " with hashphase: " << ms(stock.slowest) << " and "
            << ms(ours.slowest) << " ms a step.\n";
    }
    constexpr std::size_t kFew = 60;
    if (stock.stepCount < kFew) {
        out << "These are few steps: take the figures as a hint.\n";
    }
    if (stock.objectCount != ours.objectCount) {
        out << "The numbers of objects differ: the program does not do the same each time.\n";
    }
    if (const std::optional<double> step = projectedStep(stock, ours)) {
        out << "With hashphase a step of " << ms(*stock.step) << " ms takes " << ms(*step)
            << " ms, all else being equal (" << times(*stock.step / *step) << "); measured, "
            << ms(*ours.step) << " ms (" << times(*stock.step / *ours.step) << ").\n";
    } else {
        out << "The program has made no steps: pairs were calculated by hand.\n";
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
                        {"raysBetweenMs", row.raysBetween},
                        {"raysBetween", row.rayBetweenCount},
                        {"objects", row.objectCount},
                        {"calculations", row.calculations},
                        {"pairs", row.pairCount},
                        {"overlappingPairs", row.truePairCount != StepRow::kNotCounted
                                                 ? Json(row.truePairCount)
                                                 : Json(nullptr)}});
    }
    return {{"broadphase", jsonName(run.broadphase)},
            {"ended", textOf(run.end)},
            {"dbvts", run.dbvtCount},
            {"axisSweeps", run.axisSweepCount},
            {"derivedSweeps", run.derivedSweepCount},
            {"droppedSteps", run.droppedRows},
            {"foreignCalculations", run.foreignCalculations},
            {"otherProcesses", run.otherProcesses},
            {"steps", std::move(rows)}};
}

Json summaryJson(const StepSummary& summary) {
    return {{"steps", summary.stepCount},
            {"updateAabbsMs", summary.updateAabbs},
            {"calculateMs", summary.calculate},
            {"raysMs", summary.rays},
            {"stepMs", orNull(summary.step)},
            {"rays", summary.rayCount},
            {"raysBetweenMs", summary.raysBetween},
            {"raysBetween", summary.rayBetweenCount},
            {"objects", summary.objectCount},
            {"pairs", summary.pairCount},
            {"overlappingPairs", orNull(summary.truePairCount)}};
}

Json verifiedJson(const TriedRun& run) {
    if (run.broadphase != Broadphase::verifying) {
        return nullptr;
    }
    const tryout::Verification& pairs = run.verification;
    return {{"calculations", pairs.calculations},
            {"pairs", pairs.pairs},
            {"missing", pairs.missing},
            {"extra", pairs.extra},
            {"waitForAMove", pairs.unasked},
            {"removedByProgram", pairs.removed},
            {"notJudged", pairs.late},
            {"bulletPairs", pairs.stockPairs},
            {"bulletMissing", pairs.stockMissing},
            {"bulletExtra", pairs.stockExtra},
            {"firstFault", orNull(std::string(pairs.firstFault.data()))}};
}

}  // namespace

bool isEndOfOurs(const Trial& trial) {
    const std::vector<const TriedRun*> stock = runsOf(trial, Broadphase::stock);
    for (const TriedRun* ours : runsOf(trial, Broadphase::hash)) {
        if (std::none_of(stock.begin(), stock.end(),
                         [&](const TriedRun* run) { return areAlike(run->end, ours->end); })) {
            return true;
        }
    }
    return false;
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
    const std::optional<StepComparison> steps = compareSteps(trial);
    json["bulletStep"] = steps ? summaryJson(steps->stock) : Json(nullptr);
    json["hashphaseStep"] = steps ? summaryJson(steps->ours) : Json(nullptr);
    json["projectedStepMs"] =
        steps ? orNull(projectedStep(steps->stock, steps->ours)) : Json(nullptr);
    json["verification"] = verifiedJson(trial.runs.front());
    for (const TriedRun& run : trial.runs) {
        json["runs"].push_back(runJson(run));
    }
    out << textOf(json);
}

}  // namespace hashphase::demos
