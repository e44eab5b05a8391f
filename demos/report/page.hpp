// SPDX-License-Identifier: Zlib
#pragma once

// A report as one HTML file that needs nothing else: no network, no folder beside it.
//
// Readable  with JavaScript off: every chart has its numbers as a table.
// Safe      under a strict content-security policy, which it brings along: only its own scripts run.
// Paper     prints with all tables, in the colours of paper.
// Tabs      beside the report there may be others; see page_tab.hpp.
// Joined    pages can be the parts of one, with one list of contents and one colour a method.

#include <demos/console/program.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/chart.hpp>
#include <demos/report/check.hpp>
#include <demos/report/graded_table.hpp>
#include <demos/report/page_tab.hpp>
#include <demos/report/provenance.hpp>
#include <demos/report/series_looks.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Written in the order of the members, graded tables after the conclusions; what is empty is left out.
struct PageSection {
    std::string heading;
    std::vector<std::string> sentences;  // a paragraph each
    std::vector<std::string> conclusions;
    std::vector<Check> checks;
    std::vector<Chart> charts;
    std::vector<DataTable> tables;
    std::vector<std::string> settings;  // how it was measured
    std::vector<GradedTable> graded = {};
};

struct Page {
    std::string title;
    std::string introduction;  // for somebody who has never heard of the program
    std::string verdict;
    std::optional<bool> holds;  // all that was checked; nothing where nothing was
    std::vector<PageSection> sections;
    Provenance provenance;

    /// Pages that follow the sections, each with its verdict. They have no parts of their own, and of
    /// their provenance only the command is written. Their tabs, of other names than the page's, stand
    /// beside its report.
    std::vector<Page> parts = {};

    std::vector<PageTab> tabs = {};  // after that of the report itself
};

void writePage(const Page& page, std::ostream& out);

/// Writes the page to the file, where there is one, and hands it to whom the console names.
void deliverPage(const Page& page, ResultFile& file, const Console& console);

/// The looks of the series of all charts of a page and its parts.
[[nodiscard]] SeriesLooks seriesLooks(const Page& page);

}  // namespace hashphase::demos
