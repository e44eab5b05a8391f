// SPDX-License-Identifier: Zlib
#pragma once

// What the experiments found, as text for people, JSON for programs, CSV for spreadsheets.

#include <demos/accuracy/accuracy.hpp>

#include <iosfwd>
#include <string>

namespace hashphase::demos {

/// Experiment by experiment its tables, checks and conclusions; then the advice and the verdict.
void printReport(const AccuracyReport& report, std::ostream& out);

/// Schema "hashphase-accuracy": one experiment with its provenance.
void writeJson(const AccuracyReport& report, const Outcome& outcome, std::ostream& out);

/// Writes to the folder, which exists, <id>.json of each experiment, <name>.csv and <name>.vl.json
/// (as Vega-Lite draws it) of each chart, and advice.csv. Throws InputError when a file cannot be written.
void writeReport(const AccuracyReport& report, const std::string& folder);

}  // namespace hashphase::demos
