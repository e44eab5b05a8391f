// SPDX-License-Identifier: Zlib
#pragma once

// A report as one HTML file that needs nothing else: no network, no folder beside it.
//
// Readable  with JavaScript off: every chart has its numbers as a table.
// Safe      under a strict content-security policy, which it brings along: only its own scripts run.
// Paper     prints with all tables, in the colours of paper.
// Tabs      beside the report there may be others.
// Joined    pages can be the parts of one, with one list of contents and one colour a method.

#include <demos/console/program.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/data_table.hpp>
#include <demos/report/provenance.hpp>

#include <array>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// What must be so, and whether it is.
struct Check {
    std::string claim;  // "Swept modes miss nothing"
    bool holds = false;
    std::string evidence;  // the numbers: "0 of 1,000,000"
};

struct Chart {
    std::string name;      // of its files: "P1-missed"; letters, digits and dashes
    std::string title;     // a sentence that says what is to be seen
    std::string settings;  // on what it was measured: scene, numbers, seeds
    DataTable data;

    /// How it is drawn, in the words of a declaration (experiment/findings.hpp): "mark", "x", "series", ...
    /// charts.js draws it.
    std::map<std::string, std::string> drawn;
};

enum class Grade { kNone, kGood, kFair, kPoor };

struct GradedText {
    std::string text;
    Grade grade = Grade::kNone;

    /// With a mark behind it: "~" for fair, "!" for poor.
    [[nodiscard]] std::string marked() const;
};

/// A table whose cells are judged: by a colour that the colour-blind can tell too, and by a mark. The first two
/// columns are texts; equal texts in the first one stand once.
struct GradedTable {
    std::string caption;
    std::array<std::string, 3> legend;  // what good, fair and poor mean
    std::vector<std::string> header;
    std::vector<std::vector<GradedText>> rows;  // each as long as the header
};

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

/// A script that goes into a page, as it was when the program was built.
struct PageScript {
    std::string_view code;
    std::string_view sha256;  // of the code, in hexadecimal digits
};

/// What a page shows beside its report: a tab of its own, with a script of its own.
///
/// Without JavaScript  the tabs' contents stand below each other, after the report.
/// With it             one of them is shown; the page's address ends in #name while that is a tab's. A tab
///                     that is shown gets an event `tabshown`.
struct PageTab {
    std::string name;  // in ids and addresses: letters
    std::string title;
    std::string content;  // HTML
    std::string_view style;
    PageScript script;
};

struct Page {
    std::string title;
    std::string introduction;  // for somebody who has never heard of the program
    std::string verdict;
    std::optional<bool> holds;  // all that was checked; nothing where nothing was
    std::vector<PageSection> sections;
    Provenance provenance;

    /// Pages that follow the sections, each with its verdict; their sections are folded up. They have no parts of
    /// their own, and of their provenance only the command and an overload are written. Their tabs, of other names
    /// than the page's, stand beside its report.
    std::vector<Page> parts = {};

    std::vector<PageTab> tabs = {};  // after that of the report itself
};

void writePage(const Page& page, std::ostream& out);

/// Writes the page to the file, where there is one, and hands it to whom the console names.
void deliverPage(const Page& page, ResultFile& file, const Console& console);

// --- Of its pieces --------------------------------------------------------------------------------

/// An element: tag("a href=\"#x\"", "X") is <a href="#x">X</a>.
[[nodiscard]] std::string tag(const std::string& opening, const std::string& content);

/// The text with what HTML reads as markup escaped, for between tags and within quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// A table with the titles of the columns; numbers stand to the right, and a text of the first
/// column that is that of the rows above stands once.
void writeTable(const DataTable& table, std::ostream& out);
void writeGradedTable(const GradedTable& table, std::ostream& out);

/// How a content-security policy names the script.
[[nodiscard]] std::string policyHash(const PageScript& script);

/// The style sheet of all pages, and their script: tabs, folds, and what scrolls.
[[nodiscard]] std::string_view pageStyle();
[[nodiscard]] PageScript navigationScript();

}  // namespace hashphase::demos
