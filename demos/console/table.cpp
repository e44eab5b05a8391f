// SPDX-License-Identifier: Zlib
#include <demos/console/table.hpp>

#include <algorithm>
#include <ostream>
#include <utility>

namespace hashphase::demos {

Table::Table(std::vector<std::string> header, bool isOfWords) : isOfWords_(isOfWords) {
    rows_.push_back(std::move(header));
}

void Table::addRow(std::vector<std::string> cells) {
    rows_.push_back(std::move(cells));
}

void Table::print(std::ostream& out) const {
    std::vector<std::size_t> widths(rows_.front().size(), 0);
    for (const auto& row : rows_) {
        for (std::size_t column = 0; column < widths.size(); ++column) {
            widths[column] = std::max(widths[column], row.at(column).size());
        }
    }
    for (const auto& row : rows_) {
        std::string line = row[0] + std::string(widths[0] - row[0].size(), ' ');
        for (std::size_t column = 1; column < widths.size(); ++column) {
            const std::string blanks(widths[column] - row[column].size(), ' ');
            line += isOfWords_ ? "  " + row[column] + blanks : "  " + blanks + row[column];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
        if (&row == &rows_.front()) {
            std::size_t width = widths[0];
            for (std::size_t column = 1; column < widths.size(); ++column) {
                width += 2 + widths[column];
            }
            out << std::string(width, '-') << '\n';
        }
    }
}

}  // namespace hashphase::demos
