// SPDX-License-Identifier: Zlib
#pragma once

// Measurements as rows under named columns: the one form in which they are kept. Reports show it as a
// table, charts draw it, CSV and JSON files hold it.

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hashphase::demos {

/// A number, a text, or nothing where nothing was measured. A number that is not finite counts as
/// nothing.
using Value = std::variant<std::monostate, double, std::string>;

/// Up to it, every whole number is a double.
inline constexpr std::int64_t kMostExactWhole = std::int64_t{1} << 53;

struct DataColumn {
    std::string name;        // as in CSV and JSON: "missed", "frame_ms"
    std::string title = {};  // as people read it, with the unit: "missed pairs", "frame [ms]"
};

struct DataTable {
    std::vector<DataColumn> columns;
    std::vector<std::vector<Value>> rows;  // each as long as columns

    void add(std::vector<Value> row) { rows.push_back(std::move(row)); }

    /// The index of the column of that name; asserted to exist.
    [[nodiscard]] std::size_t columnOf(std::string_view name) const;
};

/// What stands over the column: its title, or else its name.
[[nodiscard]] const std::string& titleOf(const DataColumn& column);

/// As people read it: four significant digits, thousands separated, "-" for nothing.
[[nodiscard]] std::string valueText(const Value& value);

/// Significant digits that people read of numbers under that title: four. Of times, and of ratios of them ("[ms]",
/// "[ns/object]", "times as fast"), no more than three are worth anything.
[[nodiscard]] int digitsOf(const DataColumn& column);

/// As people read it under that title, with digitsOf(): of times "0.120", "12.0", "1,230".
[[nodiscard]] std::string cellText(const Value& value, const DataColumn& column);

/// Without the columns that have nothing in any row.
[[nodiscard]] DataTable withoutEmptyColumns(const DataTable& table);

/// Rows that are alike but for their last two cells, which follow each other, as one: of these cells the first
/// names a column, in the order of the first row, and the second is what stands in it.
[[nodiscard]] DataTable spread(const DataTable& cells);

struct TableStyle {
    std::size_t columns =
        0;  // of a line, at most: long cells have several lines; 0: as many as it takes
    bool isOfWords =
        false;  // aligned to the left as the first column is; else to the right, as numbers are
};

/// As text, a rule under the header, no blanks at line ends. A word is not broken: with many columns lines may still
/// be longer than asked for.
void printTable(const DataTable& table, std::ostream& out, const TableStyle& style = {});

/// RFC 4180: a header line of the columns' names, numbers with all digits, nothing as an empty field.
void writeCsv(const DataTable& table, std::ostream& out);

}  // namespace hashphase::demos
