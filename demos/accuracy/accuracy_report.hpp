// SPDX-License-Identifier: Zlib
#pragma once

// What the experiments found: as text and as a page for people, JSON for programs, CSV for
// spreadsheets.

#include <demos/accuracy/experiment.hpp>
#include <demos/report/page.hpp>

#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// One experiment, done.
struct Outcome {
    const Experiment* experiment = nullptr;
    Findings findings;
    double seconds = 0;
};

struct AccuracyReport {
    Effort effort;
    std::vector<Outcome> outcomes;
    std::vector<std::string> leftOut;  // ids, for want of time
    Provenance provenance;
};

/// The checks of all outcomes that do not hold, as "P1: claim (evidence)".
[[nodiscard]] std::vector<std::string> brokenChecks(const AccuracyReport& report);

/// Task by task what is worth choosing: each method costs more than those before it and gets less
/// wrong. Another's method is worth it only where none of ours gets as little wrong in a time that is at most
/// 5 % longer, or of whose spread (from its 5th percentile on) the other's time is a part. The last column,
/// the error, has other units in other tasks, and is for programs.
[[nodiscard]] DataTable adviceTable(std::span<const Choice> choices);

/// Experiment by experiment its checks, with `isVerbose` its tables and conclusions as well; then the advice and the
/// verdict.
void printReport(const AccuracyReport& report, bool isVerbose, const Console& console);

/// The verdict, what to choose, experiment by experiment what was found, and where.
[[nodiscard]] Page pageOf(const AccuracyReport& report);

/// Writes to the folder, which exists, <id>.json of each experiment (schema "hashphase-accuracy"), with the
/// charts that demos/report/draw draws, <name>.csv of each chart, and advice.csv. Throws InputError when a
/// file cannot be written.
void writeReport(const AccuracyReport& report, const std::string& folder);

}  // namespace hashphase::demos
