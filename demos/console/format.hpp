// SPDX-License-Identifier: Zlib
#pragma once

// Numbers, lists and a user's words as people read them.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// 30000 -> "30,000".
[[nodiscard]] std::string withThousands(std::uint64_t number);

/// A number with that many digits after the point.
[[nodiscard]] std::string fixed(double number, int digits);

/// Milliseconds with three significant digits: "0.0123", "1.23", "12.3", "123".
[[nodiscard]] std::string milliseconds(double number);

/// A number with all its digits, up to 15, and no more: "0.1", "30000", "1e+20".
[[nodiscard]] std::string plain(double number);

/// Bytes as "123 B", "12.3 KiB", "4.56 MiB", "7.89 GiB"; may be negative.
[[nodiscard]] std::string byteSize(std::int64_t bytes);

/// The words, and between each two the separator: "a, b, c".
[[nodiscard]] std::string joined(std::span<const std::string> words, std::string_view separator);

/// A word of a user's: not all of a long one, and nothing that a terminal would obey. UTF-8 stays whole.
[[nodiscard]] std::string printable(std::string_view word);

/// The same between quotes.
[[nodiscard]] std::string quotedWord(std::string_view word);

}  // namespace hashphase::demos
