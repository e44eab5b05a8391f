// SPDX-License-Identifier: Zlib
#include <demos/report/html.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

bool holdsNumbersOnly(const DataTable& table, std::size_t column) {
    return std::none_of(table.rows.begin(), table.rows.end(), [column](const auto& row) {
        return std::holds_alternative<std::string>(row[column]);
    });
}

void writeHeader(const DataTable& table, std::ostream& out) {
    out << "<thead><tr>";
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool isNumbers = holdsNumbersOnly(table, i);
        out << "<th scope=\"col\"" << (isNumbers ? " class=\"number\">" : ">")
            << escaped(titleOf(table.columns[i])) << "</th>";
    }
    out << "</tr></thead>\n";
}

/// How many rows from this one on begin with the same text; 0 when the one above does, too.
std::size_t rowsThatBeginLike(const DataTable& table, std::size_t row) {
    const auto isLike = [&table](std::size_t a, std::size_t b) {
        return std::holds_alternative<std::string>(table.rows[a][0]) &&
               table.rows[a][0] == table.rows[b][0];
    };
    if (row > 0 && isLike(row, row - 1)) {
        return 0;
    }
    std::size_t end = row + 1;
    while (end < table.rows.size() && isLike(row, end)) {
        ++end;
    }
    return end - row;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string html;
    for (const char letter : text) {
        switch (letter) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            case '\'':
                html += "&#39;";
                break;
            default:
                html += letter;
        }
    }
    return html;
}

std::string jsonInScript(const Json& json) {
    std::string text;
    for (const char letter : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        if (letter == '<') {
            text += "\\u003c";
        } else {
            text += letter;
        }
    }
    return text;
}

void writeTable(const DataTable& table, std::ostream& out) {
    out << "<div class=\"table\"><table>\n";
    writeHeader(table, out);
    out << "<tbody>\n";
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        out << "<tr>";
        for (std::size_t i = 0; i < table.rows[row].size(); ++i) {
            const Value& value = table.rows[row][i];
            const std::size_t span = i == 0 ? rowsThatBeginLike(table, row) : 1;
            if (span == 0) {
                continue;
            }
            out << "<td";
            if (span > 1) {
                out << " rowspan=\"" << span << '"';
            }
            out << (std::holds_alternative<std::string>(value) ? ">" : " class=\"number\">")
                << escaped(valueText(value)) << "</td>";
        }
        out << "</tr>\n";
    }
    out << "</tbody></table></div>\n";
}

}  // namespace hashphase::demos
