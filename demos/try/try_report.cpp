// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;

std::string count(double number) {
    return number < 100 && number != std::floor(number)
               ? fixed(number, 1)
               : withThousands(static_cast<std::uint64_t>(std::llround(number)));
}

std::string percent(double share) {
    return std::isfinite(share) ? fixed(100 * share, share < 0.1 ? 1 : 0) + " %" : "-";
}

std::string times(double stock, double ours) {
    return ours > 0 ? ratioText(stock / ours) : "-";
}

// --- The steps -----------------------------------------------------------------------------------

void printStepTable(const StepComparison& steps, std::ostream& out) {
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    Table table({"a step", "Bullet's", "hashphase", "ratio"});
    const auto timeRow = [&](const char* name, double a, double b) {
        table.addRow({name, milliseconds(a), milliseconds(b), times(a, b)});
    };
    const auto countRow = [&](const char* name, std::optional<double> a, std::optional<double> b) {
        table.addRow({name, a ? count(*a) : "-", b ? count(*b) : "-", ""});
    };
    timeRow("updateAabbs [ms]", stock.updateAabbs, ours.updateAabbs);
    timeRow("calculateOverlappingPairs [ms]", stock.calculate, ours.calculate);
    timeRow("rays, with what they hit [ms]", stock.rays, ours.rays);
    timeRow("these together [ms]", stock.broadphase(), ours.broadphase());
    if (stock.narrowPhase || ours.narrowPhase) {
        timeRow("narrow phase [ms]", stock.narrowPhase.value_or(0), ours.narrowPhase.value_or(0));
    }
    if (stock.step && ours.step) {
        timeRow("whole step [ms]", *stock.step, *ours.step);
        table.addRow({"share of the broadphase", percent(stock.broadphase() / *stock.step),
                      percent(ours.broadphase() / *ours.step), ""});
    }
    countRow("pairs", stock.pairCount, ours.pairCount);
    countRow("of which overlap", stock.truePairCount, ours.truePairCount);
    countRow("rays", stock.rayCount, ours.rayCount);
    if (stock.rayBetweenCount + ours.rayBetweenCount > 0) {
        countRow("rays between steps", stock.rayBetweenCount, ours.rayBetweenCount);
        timeRow("these, with what they hit [ms]", stock.raysBetween, ours.raysBetween);
    }
    countRow("objects at most", stock.objectCount, ours.objectCount);
    countRow("steps", static_cast<double>(stock.stepCount), static_cast<double>(ours.stepCount));
    table.print(out);
    out << "Times are the calling thread's processor time"
        << (steps.onThreads
                ? "; of the narrow phase, rays and whole steps, in which several threads "
                  "work, they are those on the wall.\n"
                : ".\n");
}

// "6.37 ms less in the broadphase"; empty where the two round to the same.
std::string changeText(double stock, double ours, const std::string& where) {
    const std::string change = milliseconds(std::abs(stock - ours));
    return change == milliseconds(0) ? ""
                                     : change + " ms " + (ours > stock ? "more " : "less ") + where;
}

std::string narrowPhaseText(const StepSummary& stock, const StepSummary& ours) {
    if (!stock.narrowPhase || !ours.narrowPhase) {
        return "";
    }
    const std::string where = "in the narrow phase";
    const std::string text = changeText(*stock.narrowPhase, *ours.narrowPhase, where);
    const double saved = stock.stalePairCount().value_or(0) - ours.stalePairCount().value_or(0);
    if (saved < 1) {
        return text;
    }
    return (text.empty() ? "as long " + where : text) + ", which visits " + count(ours.pairCount) +
           " pairs instead of " + count(stock.pairCount) + ", " + count(saved) +
           " of which do not overlap";
}

// What the change of a step consists of, in parts that add up.
std::string changesText(const StepSummary& stock, const StepSummary& ours) {
    const auto elsewhere = [](const StepSummary& summary) {
        return *summary.step - summary.broadphase() - summary.narrowPhase.value_or(0);
    };
    std::vector<std::string> parts{
        changeText(stock.broadphase(), ours.broadphase(), "in the broadphase"),
        narrowPhaseText(stock, ours), changeText(elsewhere(stock), elsewhere(ours), "elsewhere")};
    std::erase(parts, "");
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        text += (i == 0 ? ": " : i + 1 < parts.size() ? ", " : ", and ") + parts[i];
    }
    return text;
}

// Which times to trust where the thread was kept from working, by others or by what it waits for.
std::string trustText(const StepComparison& steps) {
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    if (steps.onThreads) {
        return "Trust the times of updateAabbs and calculateOverlappingPairs, and not those on the "
               "wall.";
    }
    if (!stock.step || !ours.step) {
        return "Trust the times above.";
    }
    return "Trust the times above, and not those by the clock on the wall: " +
           milliseconds(stock.stepOnWall) + " and " + milliseconds(ours.stepOnWall) +
           " ms a step (" + times(stock.stepOnWall, ours.stepOnWall) + ").";
}

void printHowBusy(const StepComparison& steps, const Provenance& machine, std::ostream& out) {
    constexpr double kUndisturbed = 0.9;
    const double shareOfStock = steps.stock.processorShare;
    const double shareOfOurs = steps.ours.processorShare;
    const std::string overload = overloadText(machine);
    const bool isDisturbed = std::min(shareOfStock, shareOfOurs) < kUndisturbed;
    if (overload.empty() && !isDisturbed) {
        return;
    }
    out << (overload.empty() ? "Other programs were busy, or the program waited for something"
                             : "Other programs kept the processor busy (" + overload + ")");
    if (isDisturbed) {
        out << ": the calling thread had it for " << percent(shareOfStock)
            << " of the time with Bullet's, and for " << percent(shareOfOurs) << " with hashphase. "
            << trustText(steps) << '\n';
    } else {
        out << (steps.onThreads ? ", which lengthens the times on the wall.\n"
                                : ", which these times are without.\n");
    }
}

void printCautions(const StepComparison& steps, std::ostream& out) {
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    if (steps.isCut) {
        out << "Compared are the first steps, as many as both runs have: with Bullet's broadphase "
               "there were "
            << withThousands(steps.allOfStock) << ", with hashphase "
            << withThousands(steps.allOfOurs) << ".\n";
    }
    constexpr double kLargeShare = 0.2;
    if (std::max(stock.slowestShare, ours.slowestShare) > kLargeShare) {
        out << "Times are without the slowest twentieth of the steps, which took "
            << percent(stock.slowestShare) << " of all time with Bullet's and "
            << percent(ours.slowestShare) << " with hashphase: " << milliseconds(stock.slowest)
            << " and " << milliseconds(ours.slowest) << " ms a step.\n";
    }
    constexpr std::size_t kFew = 60;
    if (stock.stepCount < kFew) {
        out << "These are few steps: take the figures as a hint.\n";
    }
    if (stock.objectCount != ours.objectCount) {
        out << "The numbers of objects differ: the program does not do the same each time.\n";
    }
}

void printVerdict(const StepComparison& steps, const Provenance& machine, std::ostream& out) {
    printCautions(steps, out);
    const StepSummary& stock = steps.stock;
    const StepSummary& ours = steps.ours;
    if (stock.step && ours.step) {
        out << "With hashphase a step takes " << milliseconds(*ours.step) << " ms instead of "
            << milliseconds(*stock.step) << " (" << times(*stock.step, *ours.step) << ")"
            << changesText(stock, ours) << ".\n";
    } else {
        out << "The program has made no steps: pairs were calculated by hand.\n";
    }
    printHowBusy(steps, machine, out);
}

// Of a trial that was ended in its first run, or whose program does something else each time.
void printNotCompared(const Trial& trial, std::ostream& out) {
    const std::vector<tryout::StepRow>& rows = trial.runs.front().rows;
    if (trial.runs.size() > 1 || rows.empty()) {
        out << "No steps were compared: the runs have none in common in which pairs were "
               "calculated.\n";
        return;
    }
    const StepSummary stock = summaryOf(rows, isOnThreads(rows));
    out << "There was no run with hashphase. With Bullet's broadphase, "
        << milliseconds(stock.broadphase()) << " ms of a step"
        << (stock.step ? " of " + milliseconds(*stock.step) + " ms" : "")
        << " were updateAabbs, calculateOverlappingPairs and rays; "
        << withThousands(stock.stepCount) << " steps, " << count(stock.objectCount)
        << " objects at most, " << count(stock.pairCount) << " pairs.\n";
}

// --- The program ---------------------------------------------------------------------------------

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
std::string endsOf(const std::vector<const TriedRun*>& runs) {
    std::set<std::string> ends;
    for (const TriedRun* run : runs) {
        ends.insert(textOf(run->end));
    }
    return joined(std::vector<std::string>(ends.begin(), ends.end()), " or ");
}

// A run that was ended by a signal or with a status that is not 0, but for those that we have stopped.
const TriedRun* findFailure(const std::vector<const TriedRun*>& runs) {
    const auto failure = std::ranges::find_if(runs, [](const TriedRun* run) {
        return !run->end.isStopped && (run->end.isCrash || run->end.code != 0);
    });
    return failure != runs.end() ? *failure : nullptr;
}

// The last line: what it ended with matters more than what it took.
void printEnds(const Trial& trial, std::ostream& out) {
    const std::vector<const TriedRun*> stock = runsOf(trial, Broadphase::stock);
    const std::vector<const TriedRun*> ours = runsOf(trial, Broadphase::hash);
    const std::string endsOfStock = endsOf(stock);
    const std::string endsOfOurs = endsOf(ours);
    const TriedRun* failure = findFailure(stock);
    const bool hasFailures = failure != nullptr || findFailure(ours) != nullptr;
    if (isEndOfOurs(trial) || (hasFailures && endsOfStock != endsOfOurs)) {
        out << "The program " << endsOfStock << " with Bullet's broadphase"
            << (endsOfOurs.empty() ? "" : ", and " + endsOfOurs + " with hashphase") << ".\n";
    } else if (failure != nullptr) {
        out << "The program " << textOf(failure->end) << ", whichever the broadphase.\n";
    }
}

void printNotes(const Trial& trial, std::ostream& out) {
    const auto most = [&trial](std::uint32_t TriedRun::*figure) {
        return std::ranges::max(trial.runs, {}, figure).*figure;
    };
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

void printPairs(const tryout::Verification& pairs, std::ostream& out) {
    Table table({"pairs", "right", "missing", "extra"});
    const auto addRow = [&table](const char* name, std::uint64_t all, std::uint64_t missing,
                                 std::uint64_t extra) {
        table.addRow(
            {name, withThousands(all - extra), withThousands(missing), withThousands(extra)});
    };
    addRow("hashphase", pairs.pairs, pairs.missing, pairs.extra);
    addRow("Bullet's", pairs.stockPairs, pairs.stockMissing, pairs.stockExtra);
    table.print(out);
    const auto note = [&out](std::uint64_t number, const char* what) {
        if (number > 0) {
            out << withThousands(number) << " times a pair was " << what << '\n';
        }
    };
    note(pairs.unasked,
         "refused that the filter would take now: the filter was changed, and nothing has moved "
         "since. See refilter().");
    note(pairs.removed,
         "missing that the program had taken out of its own cache itself: with hashphase it comes "
         "back when the two meet again.");
    note(pairs.late,
         "not judged, as a callback had moved one of the two while pairs were calculated: its turn "
         "is in the next calculation.");
    if (const std::string fault = pairs.firstFault.data(); !fault.empty()) {
        out << "The first fault, " << fault << ".\n";
    }
    out << withThousands(pairs.calculations) << " calculations of pairs verified: the pairs of "
        << "hashphase are " << (pairs.missing + pairs.extra == 0 ? "exact in each" : "NOT EXACT")
        << ".\n";
}

void printVerified(const Trial& trial, const TriedRun& run, std::ostream& out) {
    printNotes(trial, out);
    const std::string ended = "The program " + textOf(run.end);
    if (run.verification.calculations > 0) {
        printPairs(run.verification, out);
        out << (findFailure({&run}) != nullptr ? ended + ".\n" : "");
    } else if (run.end.isCrash) {
        out << ended << " before any pairs were calculated.\n";
    } else {
        out << "Nothing was verified: no pairs were calculated, and the program " << textOf(run.end)
            << ".\n";
    }
}

void printCompared(const Trial& trial, std::ostream& out) {
    const std::optional<StepComparison> steps = compareSteps(trial);
    if (steps) {
        printStepTable(*steps, out);
    }
    printNotes(trial, out);
    if (steps) {
        printVerdict(*steps, trial.provenance, out);
    } else {
        printNotCompared(trial, out);
    }
    printEnds(trial, out);
}

}  // namespace

bool isEndOfOurs(const Trial& trial) {
    const std::vector<const TriedRun*> stock = runsOf(trial, Broadphase::stock);
    return std::ranges::any_of(runsOf(trial, Broadphase::hash), [&](const TriedRun* ours) {
        return std::ranges::none_of(
            stock, [&](const TriedRun* run) { return areAlike(run->end, ours->end); });
    });
}

void printTrial(const Trial& trial, std::ostream& out) {
    out << headOf(trial) << "\n\n";
    if (trial.runs.front().broadphase == Broadphase::verifying) {
        printVerified(trial, trial.runs.front(), out);
    } else {
        printCompared(trial, out);
    }
}

}  // namespace hashphase::demos
