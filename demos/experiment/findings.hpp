// SPDX-License-Identifier: Zlib
#pragma once

// What an experiment found, and its declaration in SQL that makes it of what was measured.
//
// A declaration is a file of SQL statements. A statement whose comment in front of it holds JSON is shown
// to people; the others prepare (CREATE VIEW). The JSON says as what:
//
//   {"settings": "how"}             sentences on scenes, sizes, truth; a row each
//   {"conclusions": "what"}         sentences that the numbers show, bad news included; nulls are left out
//   {"checks": "what"}              claim, holds, evidence
//   {"choices": "what"}             task, method, milliseconds, error, result, ours, 5th percentile of the
//                                   milliseconds
//   {"table": "what"}               a table, of which a column "name: title" is headed by its title
//   {"rows": "what"}                a table for the program itself, by that name
//   {"chart": "P4-lost", "title": .., "settings": .., "mark": "bar", "x": "setting names", "y": "lost log"}
//                                   a chart (charts.js). Marks:
//                                     line    a line with points a series, in the order of the rows
//                                     point   points; where x are names, each on a line of its own
//                                     bar     bars side by side; x are names, and y is linear
//                                     cell    a heat map: x and y are names; numbers among them grow upwards
//                                   An axis is a column, of whose title it has its own, and a scale:
//                                     linear  where none is named
//                                     log     every number above 0
//                                     log0    as log, with 0 apart at the lower end
//                                     names   texts, in the order of the rows
//     "series": "method"              the column that tells lines, points or bars apart. A method's colour is the
//                                     same on all pages (report/method_looks.js); "method, variant" has it, too
//     "low": "p5", "high": "p95"      the columns of an error bar around y
//     "label": "step"                 a column of texts that name single points
//     "shade": "ns log"               an axis: the colour of cells
//     "theory": "limit"               a column with what theory says for this x: a dashed line
//     "front": true                   a line through the points that no other beats in both x and y
//
//   {"verdict": "of all"}           a sentence, and whether all that is checked holds: 1, 0, or null where nothing
//                                   was compared
//   {"print": "caption"}            a table for the report of text
//
// Pages of several sections: what has "section": "heading" beside these goes there. A section begins with
//
//   {"sentences": "what", "section": "heading"}
//                                   a row each; where there are none, the page goes without the section
//   {"graded": "caption", "legend": [good, fair, poor], "section": ..}
//                                   a row for each cell: what heads its row, twice; what heads its column; its
//                                   text; its grade, "good", "fair", "poor" or null
//
// A table or rows of "spread": true has columns by name: the last two columns of its SELECT are the name of a
// column and what stands in it; see spread() in data_table.hpp.
//
// Beside all these, "each" holds a SELECT for whose rows the statement is shown in turn, with their columns as
// parameters ":name"; statements in a row with the same "each" are shown together for each of its rows, but
// for those whose "when" is "0". In names, titles and settings of charts, in captions, headings, titles of
// columns and in "when", "{...}" is an expression over the view `texts`, which the declaration makes, and
// these parameters.

#include <demos/experiment/measurements.hpp>
#include <demos/report/page.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

/// A method as a choice that somebody has: what it costs, what it gets wrong.
struct Choice {
    std::string task;    // what is bought; choices of the same task compete: "Fast movers, 30,000"
    std::string method;  // "Sweep::line"
    double milliseconds = 0;  // a frame
    double error = 0;         // 0 is exact; comparable within a task
    std::string result;       // the error in words, with its unit: "misses 3.1 % of contacts"
    bool isOurs = true;       // else of the paper or of Bullet, for comparison
    double low = 0;           // 5th percentile [ms]
};

struct Findings {
    std::vector<std::string> settings;
    std::vector<Chart> charts;
    std::vector<DataTable> tables;
    std::vector<Check> checks;
    std::vector<Choice> choices;
    std::vector<std::string> conclusions;
    std::map<std::string, DataTable, std::less<>> rows;
    std::string verdict;
    std::optional<bool> holds;  // all that is checked
    std::vector<PageSection> sections;
    std::vector<std::pair<std::string, DataTable>> printed;  // under their captions
};

/// The texts of the table's first column.
[[nodiscard]] std::vector<std::string> sentencesOf(const DataTable& table);

/// What the declaration shows of what was measured. Throws std::logic_error that names a fault of the
/// declaration.
[[nodiscard]] Findings findingsOf(std::string_view declaration, Measurements& measured);

}  // namespace hashphase::demos
