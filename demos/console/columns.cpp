// SPDX-License-Identifier: Zlib
#include <demos/console/columns.hpp>

#include <demos/console/program.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

bool beginsCharacter(char byte) noexcept {
    return (byte & 0xc0) != 0x80;
}

void wrapLine(std::string_view line, std::size_t columns, std::size_t indent, std::string& out) {
    std::size_t column = 0;  // that is written next
    for (;;) {
        const std::size_t blanks = std::min(line.find_first_not_of(' '), line.size());
        if (blanks == line.size()) {
            return;
        }
        const std::size_t end = std::min(line.find(' ', blanks), line.size());
        const std::size_t width = columnsOf(line.substr(0, end));
        if (column == 0 || column + width <= columns) {
            out += line.substr(0, end);
            column += width;
        } else {
            out += '\n' + std::string(indent, ' ');
            out += line.substr(blanks, end - blanks);
            column = indent + width - blanks;
        }
        line.remove_prefix(end);
    }
}

}  // namespace

std::size_t lineWidth(const Console& console) noexcept {
    return console.columns == 0 ? kMostColumns : std::min(console.columns, kMostColumns);
}

std::size_t columnsOf(std::string_view text) noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(text, beginsCharacter));
}

std::string clipped(std::string_view text, std::size_t columns) {
    if (columnsOf(text) <= columns) {
        return std::string(text);
    }
    constexpr std::string_view kMore = "...";
    std::size_t left = columns - std::min(columns, kMore.size());
    std::size_t end = 0;
    while (end < text.size() && !(beginsCharacter(text[end]) && left-- == 0)) {
        ++end;
    }
    return std::string(text.substr(0, end)) += kMore.substr(0, columns);
}

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent) {
    std::string lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        wrapLine(text.substr(0, end), columns, indent, lines);
        if (end < text.size()) {
            lines += '\n';
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace hashphase::demos
