// SPDX-License-Identifier: Zlib
#include <demos/report/graded_table.hpp>

#include <demos/report/html.hpp>

#include <ostream>

namespace hashphase::demos {
namespace {

std::string_view classOf(Grade grade) {
    switch (grade) {
        case Grade::kNone:
            return "number";
        case Grade::kGood:
            return "number good";
        case Grade::kFair:
            return "number fair";
        case Grade::kPoor:
            return "number poor";
    }
    return {};
}

void writeGradedRow(const std::vector<GradedText>& row, std::size_t rowsOfFirst,
                    std::ostream& out) {
    out << "<tr>";
    if (rowsOfFirst > 0) {
        out << "<th scope=\"rowgroup\" rowspan=\"" << rowsOfFirst << "\">" << escaped(row[0].text)
            << "</th>";
    }
    for (std::size_t i = 1; i < row.size(); ++i) {
        out << "<td";
        if (i > 1) {
            out << " class=\"" << classOf(row[i].grade) << '"';
        }
        out << '>' << escaped(row[i].marked()) << "</td>";
    }
    out << "</tr>\n";
}

}  // namespace

std::string_view markOf(Grade grade) {
    switch (grade) {
        case Grade::kNone:
        case Grade::kGood:
            return "";
        case Grade::kFair:
            return "~";
        case Grade::kPoor:
            return "!";
    }
    return {};
}

void writeGradedTable(const GradedTable& table, std::ostream& out) {
    out << "<div class=\"table\"><table class=\"graded\">\n<caption>" << escaped(table.caption)
        << "<br>";
    constexpr std::array kGrades{Grade::kGood, Grade::kFair, Grade::kPoor};
    for (std::size_t i = 0; i < kGrades.size(); ++i) {
        out << " <span class=\"" << classOf(kGrades[i]) << "\">"
            << escaped(GradedText{table.legend[i] + " ", kGrades[i]}.marked()) << "</span>";
    }
    out << "</caption>\n<thead><tr>";
    for (std::size_t i = 0; i < table.header.size(); ++i) {
        out << "<th scope=\"col\"" << (i > 1 ? " class=\"number\">" : ">")
            << escaped(table.header[i]) << "</th>";
    }
    out << "</tr></thead>\n<tbody>\n";
    for (std::size_t row = 0; row < table.rows.size();) {
        std::size_t end = row + 1;
        while (end < table.rows.size() && table.rows[end][0].text == table.rows[row][0].text) {
            ++end;
        }
        for (std::size_t i = row; i < end; ++i) {
            writeGradedRow(table.rows[i], i == row ? end - row : 0, out);
        }
        row = end;
    }
    out << "</tbody></table></div>\n";
}

}  // namespace hashphase::demos
