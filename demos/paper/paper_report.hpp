// SPDX-License-Identifier: Zlib
#pragma once

// The paper's figures then and today, as text, JSON, CSV and a page with charts.

#include <demos/paper/paper_results.hpp>
#include <demos/report/page.hpp>

#include <iosfwd>
#include <string>

namespace hashphase::demos {

struct PaperReport {
    PaperResults results;
    Provenance provenance;
};

/// The figures as tables; `showMilliseconds` in place of frames a second.
void printReport(const PaperReport& report, bool showMilliseconds, std::ostream& out);

/// Schema "hashphase-paper".
void writeJson(const PaperReport& report, std::ostream& out);

/// A row for each method of each part.
void writeCsv(const PaperReport& report, std::ostream& out);

/// All of it as a page with charts.
[[nodiscard]] Page pageOf(const PaperReport& report);

/// How many of the paper's cells that are too slow are real-time today, and whether all is right.
[[nodiscard]] std::string verdictLine(const PaperResults& results);

/// What of visibility is hashing, and where the paper's grid is faster than hashphase.
[[nodiscard]] std::vector<std::string> observations(const PaperResults& results);

/// How it was measured, a sentence each.
[[nodiscard]] std::vector<std::string> howItWasMeasured(const PaperResults& results);

}  // namespace hashphase::demos
