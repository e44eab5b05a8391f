// SPDX-License-Identifier: Zlib
#include <demos/try/try_report.hpp>

#include <demos/console/format.hpp>
#include <demos/console/table.hpp>
#include <demos/try/try_comparison.hpp>

#include <algorithm>
#include <ostream>
#include <set>

namespace hashphase::demos {
namespace {

using tryout::Broadphase;

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

// The last line: what it ended with matters more than what it took.
void printEnds(const Trial& trial, std::ostream& out) {
    const TriedRun* stock = findFailure(runsOf(trial, Broadphase::stock));
    const TriedRun* ours = findFailure(runsOf(trial, Broadphase::hash));
    const std::string endsOfStock = endsOf(trial, Broadphase::stock);
    const std::string endsOfOurs = endsOf(trial, Broadphase::hash);
    const bool hasFailures = stock != nullptr || ours != nullptr;
    if (isEndOfOurs(trial) || (hasFailures && endsOfStock != endsOfOurs)) {
        out << "The program " << endsOfStock << " with Bullet's broadphase"
            << (endsOfOurs.empty() ? "" : ", and " + endsOfOurs + " with hashphase") << ".\n";
    } else if (stock != nullptr) {
        out << "The program " << textOf(stock->end) << ", whichever the broadphase.\n";
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
    printNotes(trial, out);
    if (pairs.calculations == 0) {
        out << (run.end.isCrash
                    ? "The program " + textOf(run.end) + " before any pairs were calculated.\n"
                    : "Nothing was verified: no pairs were calculated, and the program " +
                          textOf(run.end) + ".\n");
        return;
    }
    Table table({"pairs", "right", "missing", "extra"});
    table.addRow({"hashphase", withThousands(pairs.pairs - pairs.extra),
                  withThousands(pairs.missing), withThousands(pairs.extra)});
    table.addRow({"Bullet's", withThousands(pairs.stockPairs - pairs.stockExtra),
                  withThousands(pairs.stockMissing), withThousands(pairs.stockExtra)});
    table.print(out);
    if (pairs.unasked > 0) {
        out << withThousands(pairs.unasked)
            << " times a pair was refused that the filter would take now: the filter was changed, "
               "and nothing has moved since. See refilter().\n";
    }
    if (pairs.removed > 0) {
        out << withThousands(pairs.removed)
            << " times a pair was missing that the program had taken out of its own cache itself: "
               "with hashphase it comes back when the two meet again.\n";
    }
    if (pairs.late > 0) {
        out << withThousands(pairs.late)
            << " times a pair was not judged, as a callback had moved one of the two while pairs "
               "were calculated: its turn is in the next calculation.\n";
    }
    if (const std::string fault = pairs.firstFault.data(); !fault.empty()) {
        out << "The first fault, " << fault << ".\n";
    }
    out << withThousands(pairs.calculations) << " calculations of pairs verified: the pairs of "
        << "hashphase are " << (pairs.missing + pairs.extra == 0 ? "exact in each" : "NOT EXACT")
        << ".\n";
    if (findFailure({&run}) != nullptr) {
        out << "The program " << textOf(run.end) << ".\n";
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

}  // namespace hashphase::demos
