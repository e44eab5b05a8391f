// SPDX-License-Identifier: Zlib
#pragma once

// Lines that fit a terminal. A character of UTF-8 takes a column.

#include <cstddef>
#include <string>
#include <string_view>

namespace hashphase::demos {

struct Console;

inline constexpr std::size_t kMostColumns = 100;  // of a line that is easy to read
inline constexpr std::size_t kHelpIndent = 30;    // of descriptions in help

/// How long lines of results may be: the terminal's columns, and at most kMostColumns.
[[nodiscard]] std::size_t lineWidth(const Console& console) noexcept;

[[nodiscard]] std::size_t columnsOf(std::string_view text) noexcept;

/// The text in at most so many columns; what is too long ends in "...".
[[nodiscard]] std::string clipped(std::string_view text, std::size_t columns);

/// The text in lines of at most so many columns, broken at blanks; a longer word has a line of its own. After such a
/// break a line begins with `indent` blanks; breaks of the text's own stay.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t columns,
                                  std::size_t indent = 0);

}  // namespace hashphase::demos
