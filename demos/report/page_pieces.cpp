// SPDX-License-Identifier: Zlib
#include <demos/report/page.hpp>

#include <algorithm>
#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

/// A table, cell by cell; looks are classes of the style sheet.
struct Cell {
    std::string text;
    std::string look = {};
    std::size_t rows = 1;  // that it spans; 0: the one above does, and it is not there
};

std::string tableOf(const std::string& opening, const std::string& caption,
                    const std::string& firstElement, const std::vector<Cell>& header,
                    const std::vector<std::vector<Cell>>& rows) {
    const auto element = [](std::string of, const Cell& cell) {
        of += cell.rows > 1 ? " rowspan=\"" + std::to_string(cell.rows) + '"' : "";
        of += cell.look.empty() ? "" : " class=\"" + cell.look + '"';
        return cell.rows > 0 ? tag(of, escaped(cell.text)) : std::string();
    };
    std::string titles;
    for (const Cell& cell : header) {
        titles += element("th scope=\"col\"", cell);
    }
    std::string body;
    for (const std::vector<Cell>& row : rows) {
        std::string cells;
        for (const Cell& cell : row) {
            cells += element(&cell == row.data() ? firstElement : "td", cell);
        }
        body += tag("tr", cells) + '\n';
    }
    return tag("div class=\"table\"",
               tag(opening, '\n' + caption + tag("thead", tag("tr", titles)) + '\n' +
                                tag("tbody", '\n' + body))) +
           '\n';
}

/// Has a first cell that is like the one above be there once.
template <class AreAlike>
void join(std::vector<std::vector<Cell>>& rows, const AreAlike& areAlike) {
    std::size_t first = 0;
    for (std::size_t row = 1; row < rows.size(); ++row) {
        if (areAlike(first, row)) {
            ++rows[first][0].rows;
            rows[row][0].rows = 0;
        } else {
            first = row;
        }
    }
}

std::string htmlOf(const DataTable& table) {
    const auto isText = [](const Value& value) { return value.index() == 2; };
    std::vector<Cell> header;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool hasText = std::any_of(table.rows.begin(), table.rows.end(),
                                         [&](const auto& row) { return isText(row[i]); });
        header.push_back({titleOf(table.columns[i]), hasText ? "" : "number"});
    }
    std::vector<std::vector<Cell>> rows;
    for (const std::vector<Value>& values : table.rows) {
        std::vector<Cell> row;
        for (std::size_t i = 0; i < values.size(); ++i) {
            row.push_back(
                {cellText(values[i], table.columns[i]), isText(values[i]) ? "" : "number"});
        }
        rows.push_back(std::move(row));
    }
    join(rows, [&](std::size_t a, std::size_t b) {
        return isText(table.rows[a][0]) && table.rows[a][0] == table.rows[b][0];
    });
    return tableOf("table", "", "td", header, rows);
}

std::string lookOf(Grade grade) {
    constexpr std::array kLooks{"number", "number good", "number fair", "number poor"};
    return kLooks.at(static_cast<std::size_t>(grade));
}

std::string htmlOf(const GradedTable& table) {
    std::string legend;
    for (std::size_t i = 0; i < table.legend.size(); ++i) {
        const GradedText meaning{table.legend[i] + " ", static_cast<Grade>(i + 1)};
        legend += (i > 0 ? " " : "") +
                  tag("span class=\"" + lookOf(meaning.grade) + '"', escaped(meaning.marked()));
    }
    const std::string caption = tag("p", escaped(table.caption)) + tag("p", legend);
    std::vector<Cell> header;
    for (const std::string& title : table.header) {
        header.push_back({title, header.size() > 1 ? "number" : ""});
    }
    std::vector<std::vector<Cell>> rows;
    for (const std::vector<GradedText>& texts : table.rows) {
        std::vector<Cell> row;
        for (const GradedText& text : texts) {
            row.push_back({text.marked(), row.size() > 1 ? lookOf(text.grade) : ""});
        }
        rows.push_back(std::move(row));
    }
    join(rows, [&](std::size_t a, std::size_t b) { return rows[a][0].text == rows[b][0].text; });
    return tableOf("table class=\"graded\"", tag("caption", caption) + '\n',
                   "th scope=\"rowgroup\"", header, rows);
}

}  // namespace

std::string GradedText::marked() const {
    return text + (grade == Grade::kFair ? "~" : grade == Grade::kPoor ? "!" : "");
}

std::string tag(const std::string& opening, const std::string& content) {
    return "<" + opening + ">" + content + "</" + opening.substr(0, opening.find(' ')) + ">";
}

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

void writeTable(const DataTable& table, std::ostream& out) {
    out << htmlOf(table);
}

void writeGradedTable(const GradedTable& table, std::ostream& out) {
    out << htmlOf(table);
}

}  // namespace hashphase::demos
