// SPDX-License-Identifier: Zlib
#include <demos/report/data_table.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <stdexcept>

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

bool isOfTimes(const DataColumn& column) {
    constexpr std::array<std::string_view, 9> kUnits{
        "[ms]", "[ms ", "[us]", "[ns]", "[ns ", "[ns/", "[s]", "[times ", "times as fast"};
    const std::string& title = titleOf(column);
    return std::any_of(kUnits.begin(), kUnits.end(), [&](std::string_view unit) {
        return title.find(unit) != std::string::npos;
    });
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

void printTable(const DataTable& table, std::ostream& out, bool isOfWords) {
    std::vector<std::vector<std::string>> lines(table.rows.size() + 1);  // the header first
    std::vector<std::size_t> widths;
    std::size_t widthOfRule = 0;
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        lines[0].push_back(titleOf(table.columns[column]));
        std::size_t width = lines[0].back().size();
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            lines[row + 1].push_back(cellText(table.rows[row].at(column), table.columns[column]));
            width = std::max(width, lines[row + 1].back().size());
        }
        widths.push_back(width);
        widthOfRule += (column > 0 ? 2 : 0) + width;
    }
    for (const std::vector<std::string>& cells : lines) {
        std::string line;
        for (std::size_t column = 0; column < cells.size(); ++column) {
            const std::string blanks(widths[column] - cells[column].size(), ' ');
            const bool isToTheLeft = column == 0 || isOfWords;
            line += column > 0 ? "  " : "";
            line += isToTheLeft ? cells[column] + blanks : blanks + cells[column];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
        if (&cells == lines.data()) {
            out << std::string(widthOfRule, '-') << '\n';
        }
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
