// SPDX-License-Identifier: Zlib
#pragma once

// What the broadphases do in hard cases, as text for people, JSON for programs, CSV for spreadsheets, a
// page for browsers.

#include <demos/report/page.hpp>
#include <demos/stability/stability.hpp>

#include <iosfwd>
#include <string>

namespace hashphase::demos {

/// In a word or two: "exact", "-3 +12", "costly 12x", "> 2 s", "crashes"; "-" for nothing.
[[nodiscard]] std::string outcomeText(const CaseOutcome& outcome);

/// A row for each case; all about each case where that was asked for; what is not as required; the
/// verdict.
void printReport(const StabilityReport& report, std::ostream& out);

/// Schema "hashphase-stability".
void writeJson(const StabilityReport& report, std::ostream& out);

/// A row for each case and broadphase.
void writeCsv(const StabilityReport& report, std::ostream& out);

/// The table, and all about each case, as a page.
[[nodiscard]] Page pageOf(const StabilityReport& report);

}  // namespace hashphase::demos
