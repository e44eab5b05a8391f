// SPDX-License-Identifier: Zlib
#pragma once

// A finished comparison as text or a page for people, JSON for programs, CSV for spreadsheets.

#include <demos/compare/compare.hpp>
#include <demos/compare/comparison.hpp>
#include <demos/report/page.hpp>

#include <iosfwd>
#include <optional>
#include <string>

namespace hashphase::demos {

/// All that the reports say.
struct Report {
    CompareOptions options;
    std::string scene;  // name or path
    std::string description;
    std::string noun;
    std::size_t objects = 0;
    int framesAsked = 0;
    Comparison comparison;
    Provenance provenance;
    std::optional<ReplayRecording> replay;  // of the first frames
};

/// How many times faster than `dbvt` this broadphase was, by the medians of setAabb + calculate;
/// nothing without a measurement of both.
[[nodiscard]] std::optional<double> speedAgainstDbvt(const Report& report, const Result& result);

/// True when no broadphase of ours missed or invented a pair; nothing when none of ours took part, or no
/// frame was run.
[[nodiscard]] std::optional<bool> oursWereExact(const Report& report);

/// What became of a broadphase that was not filled in time, in a sentence; empty for the others.
[[nodiscard]] std::string leftOutSentence(const Report& report, const Result& result);

/// One sentence: objects, frames, times, ratio, and whether the pair sets were exact.
[[nodiscard]] std::string verdictLine(const Report& report);

/// What was run on what, the table, and the verdict.
void printReport(const Report& report, std::ostream& out);

/// Schema "hashphase-compare"; what was not measured is null, never NaN.
void writeJson(const Report& report, std::ostream& out);

/// All of it as a page with charts.
[[nodiscard]] Page pageOf(const Report& report);

/// A header line, then a line for each frame of each broadphase.
void writeCsv(const Report& report, std::ostream& out);

}  // namespace hashphase::demos
