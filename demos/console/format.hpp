// SPDX-License-Identifier: Zlib
#pragma once

// Numbers, lists and a user's words as people read them, and numbers as people type them: blanks around them
// do not matter, and ',', '_' or '\'' may stand between groups of three digits, one of them throughout.

#include <cstdint>
#include <optional>
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

/// The bytes of the character of UTF-8 with which the text begins; 0 if it begins with none.
[[nodiscard]] std::size_t characterLength(std::string_view text) noexcept;

/// The text with '?' instead of bytes that are no UTF-8, and of characters that a terminal would obey.
[[nodiscard]] std::string masked(std::string_view text);

/// A word of a user's, masked, and not all of a long one.
[[nodiscard]] std::string printable(std::string_view word);

/// The same between quotes.
[[nodiscard]] std::string quotedWord(std::string_view word);

/// What follows a sentence about a name that is none: "; did you mean 'paper'?", with such quotes; or all names,
/// where none is near enough to be meant: more than a third of the letters differ, and more than two.
[[nodiscard]] std::string suggestion(std::string_view name, std::span<const std::string> known,
                                     const std::string& quote);

/// "There is no scene 'papr'; did you mean 'paper'?"
[[nodiscard]] std::string unknownNameSentence(std::string_view whatItIs, std::string_view name,
                                              std::span<const std::string> known);

/// The whole number: "100000", "100,000", "1e5", "2.5e3", "+7". Nothing for what is none, is negative, or is
/// beyond 2^64 - 1.
[[nodiscard]] std::optional<std::uint64_t> wholeNumber(std::string_view word);

/// The number, nearest double; nothing for what is none, is not finite, or is beyond 1.8e308.
[[nodiscard]] std::optional<double> finiteNumber(std::string_view word);

/// The word without the blanks around it.
[[nodiscard]] std::string_view withoutBlanks(std::string_view word);

}  // namespace hashphase::demos
