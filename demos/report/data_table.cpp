// SPDX-License-Identifier: Zlib
#include <demos/report/data_table.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace hashphase::demos {
namespace {

std::string csvField(const Value& value) {
    if (const double* number = std::get_if<double>(&value)) {
        if (!std::isfinite(*number)) {
            return {};
        }
        char digits[32];  // enough for any double
        const auto end = std::to_chars(std::begin(digits), std::end(digits), *number).ptr;
        return {std::begin(digits), end};
    }
    const std::string* text = std::get_if<std::string>(&value);
    if (text == nullptr || text->find_first_of(",\"\r\n") == std::string::npos) {
        return text != nullptr ? *text : std::string();
    }
    std::string quoted = "\"";
    for (const char letter : *text) {
        quoted += letter;
        if (letter == '"') {
            quoted += letter;
        }
    }
    return quoted + '"';
}

std::string signedThousands(double number) {
    const std::string digits =
        withThousands(static_cast<std::uint64_t>(std::llround(std::abs(number))));
    return number < 0 ? "-" + digits : digits;
}

// --- Text ----------------------------------------------------------------------------------------

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

constexpr std::size_t kGap = 2;  // between columns

Rows textsOf(const DataTable& table) {
    Rows rows(1);
    for (const DataColumn& column : table.columns) {
        rows[0].push_back(titleOf(column));
    }
    for (const std::vector<Value>& values : table.rows) {
        Row& row = rows.emplace_back();
        for (std::size_t i = 0; i < values.size(); ++i) {
            row.push_back(cellText(values[i], table.columns[i]));
        }
    }
    return rows;
}

std::size_t longestWord(std::string_view text) {
    std::size_t longest = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        longest = std::max(longest, columnsOf(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return longest;
}

std::size_t lineWidthOf(const std::vector<std::size_t>& widths) {
    return std::accumulate(widths.begin(), widths.end(),
                           kGap * (std::max<std::size_t>(widths.size(), 1) - 1));
}

// The widest columns become narrower, down to their longest words, until all fit; 0: there is room for any.
std::vector<std::size_t> widthsFor(const Rows& rows, std::size_t room) {
    std::vector<std::size_t> widths(rows[0].size());
    std::vector<std::size_t> least(widths.size());
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], columnsOf(row[i]));
            least[i] = std::max(least[i], longestWord(row[i]));
        }
    }
    std::size_t sum = lineWidthOf(widths);
    while (room > 0 && sum > room) {
        std::size_t* widest = nullptr;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            if (widths[i] > least[i] && (widest == nullptr || widths[i] > *widest)) {
                widest = &widths[i];
            }
        }
        if (widest == nullptr) {
            break;
        }
        --*widest;
        --sum;
    }
    return widths;
}

// A cell that is wider than its column has several lines.
std::string linesOf(const Row& row, const std::vector<std::size_t>& widths,
                    const TableStyle& style) {
    std::vector<Row> lines(1, Row(row.size()));
    for (std::size_t column = 0; column < row.size(); ++column) {
        std::istringstream cell(wrapped(row[column], widths[column]));
        std::size_t i = 0;
        for (std::string part; std::getline(cell, part); ++i) {
            lines.resize(std::max(lines.size(), i + 1), Row(row.size()));
            lines[i][column] = std::move(part);
        }
    }
    std::string text;
    for (const Row& parts : lines) {
        for (std::size_t column = 0; column < parts.size(); ++column) {
            const std::string blanks(
                widths[column] - std::min(widths[column], columnsOf(parts[column])), ' ');
            const bool isToTheLeft = column == 0 || style.isOfWords;
            text += column > 0 ? std::string(kGap, ' ') : "";
            text += isToTheLeft ? parts[column] + blanks : blanks + parts[column];
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}

}  // namespace

std::size_t DataTable::columnOf(std::string_view name) const {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [name](const DataColumn& each) { return each.name == name; });
    if (found == columns.end()) {
        throw std::logic_error("There is no column '" + std::string(name) + "'.");
    }
    return static_cast<std::size_t>(found - columns.begin());
}

const std::string& titleOf(const DataColumn& column) {
    return column.title.empty() ? column.name : column.title;
}

namespace {

bool isOfTimes(const DataColumn& column) {
    constexpr std::array<std::string_view, 9> kUnits{
        "[ms]", "[ms ", "[us]", "[ns]", "[ns ", "[ns/", "[s]", "[times ", "times as fast"};
    const std::string& title = titleOf(column);
    return std::any_of(kUnits.begin(), kUnits.end(), [&](std::string_view unit) {
        return title.find(unit) != std::string::npos;
    });
}

}  // namespace

int digitsOf(const DataColumn& column) {
    return isOfTimes(column) ? 3 : 4;
}

std::string valueText(const Value& value) {
    if (const std::string* text = std::get_if<std::string>(&value)) {
        return *text;
    }
    const double* number = std::get_if<double>(&value);
    if (number == nullptr || !std::isfinite(*number)) {
        return "-";
    }
    if (std::abs(*number) >= 1000 && std::abs(*number) < 1e15) {
        return signedThousands(*number);
    }
    char digits[32];
    const auto end =
        std::to_chars(std::begin(digits), std::end(digits), *number, std::chars_format::general, 4)
            .ptr;
    return {std::begin(digits), end};
}

std::string cellText(const Value& value, const DataColumn& column) {
    const double* number = std::get_if<double>(&value);
    if (number == nullptr || !std::isfinite(*number) || *number == 0 || !isOfTimes(column)) {
        return valueText(value);
    }
    // The power of ten of the first digit, once rounded: 9.999 is 10.0.
    const double size = std::abs(*number);
    int power = static_cast<int>(std::floor(std::log10(size)));
    power += size >= 9.995 * std::pow(10, power) ? 1 : 0;
    if (power >= 3) {
        const double step = std::pow(10, power - 2);
        return signedThousands(std::round(*number / step) * step);
    }
    return fixed(*number, 2 - power);
}

DataTable withoutEmptyColumns(const DataTable& table) {
    DataTable kept;
    kept.rows.resize(table.rows.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const auto isEmpty = [i](const std::vector<Value>& row) { return row[i].index() == 0; };
        if (std::all_of(table.rows.begin(), table.rows.end(), isEmpty)) {
            continue;
        }
        kept.columns.push_back(table.columns[i]);
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            kept.rows[row].push_back(table.rows[row][i]);
        }
    }
    return kept;
}

DataTable spread(const DataTable& cells) {
    const auto keys = static_cast<std::ptrdiff_t>(cells.columns.size()) - 2;
    DataTable table;
    table.columns.assign(cells.columns.begin(), cells.columns.begin() + keys);
    for (const std::vector<Value>& cell : cells.rows) {
        const auto endOfKeys = cell.begin() + keys;
        if (table.rows.empty() || !std::equal(cell.begin(), endOfKeys, table.rows.back().begin())) {
            table.add({cell.begin(), endOfKeys});
        }
        if (table.rows.size() == 1) {
            table.columns.push_back({valueText(*endOfKeys)});
        }
        table.rows.back().push_back(cell.back());
    }
    return table;
}

void printTable(const DataTable& table, std::ostream& out, const TableStyle& style) {
    const Rows rows = textsOf(table);  // the header first
    const std::vector<std::size_t> widths = widthsFor(rows, style.columns);
    out << linesOf(rows.front(), widths, style);
    out << std::string(lineWidthOf(widths), '-') << '\n';
    for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
        out << linesOf(*row, widths, style);
    }
}

void writeCsv(const DataTable& table, std::ostream& out) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        out << (i > 0 ? "," : "") << csvField(table.columns[i].name);
    }
    out << '\n';
    for (const std::vector<Value>& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            out << (i > 0 ? "," : "") << csvField(row[i]);
        }
        out << '\n';
    }
}

}  // namespace hashphase::demos
