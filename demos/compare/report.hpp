// SPDX-License-Identifier: Zlib
#pragma once

// A finished comparison as text or a page for people, JSON for programs, CSV for spreadsheets: what
// compare.sql makes of it.

#include <demos/experiment/findings.hpp>
#include <demos/replay/replay_recording.hpp>
#include <demos/report/page.hpp>

#include <iosfwd>
#include <optional>
#include <string>

namespace hashphase::demos {

/// All that the reports say.
struct CompareReport {
    std::string scene;  // name or path
    int framesDone = 0;
    bool wasAnythingTimed = false;
    Findings findings;
    Provenance provenance;
    std::optional<ReplayRecording> replay;  // of the first frames
};

/// Measured are the run, its broadphases and its frames. All that is checked are the pair sets of ours.
[[nodiscard]] Findings compareFindings(Measurements& measured);

/// What was run on what, a table, and the verdict; with `isVerbose` all columns, and the parts of a step.
void printReport(const CompareReport& report, bool isVerbose, const Console& console);

/// Schema "hashphase-compare"; what was not measured is null, never NaN.
void writeJson(const CompareReport& report, std::ostream& out);

/// All of it as a page with charts.
[[nodiscard]] Page pageOf(const CompareReport& report);

}  // namespace hashphase::demos
