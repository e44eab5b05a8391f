// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>

#include <demos/console/from_chars.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

namespace hashphase::demos {
namespace {

// Whether the digits come in groups of three, but for the first, which may be shorter.
bool areGroups(std::string_view text, char separator) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isBetween = (text.size() - i) % 4 == 0;
        const bool isRight =
            isBetween ? i > 0 && text[i] == separator : text[i] >= '0' && text[i] <= '9';
        if (!isRight) {
            return false;
        }
    }
    return true;
}

// The number without blanks, separators and a leading '+'; empty where they are out of place.
std::string plainSpelling(std::string_view word) {
    word = withoutBlanks(word);
    if (word.starts_with('+') && word.substr(1, 1).find_first_of("+-") == std::string_view::npos) {
        word.remove_prefix(1);
    }
    const bool isNegative = word.starts_with('-');
    const std::string_view whole = word.substr(0, word.find_first_of(".eE")).substr(isNegative);
    std::string plain(word);
    const std::size_t separator = whole.find_first_of(",_'");
    if (separator != std::string_view::npos) {
        if (!areGroups(whole, whole[separator])) {
            return {};
        }
        std::erase(plain, whole[separator]);
    }
    return plain;
}

// The power of ten behind 'e'; nothing for what is none.
std::optional<int> exponentOf(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) {
        text.remove_prefix(1);
    }
    int exponent = 0;
    const char* const end = text.data() + text.size();
    if (std::from_chars(text.data(), end, exponent) != std::from_chars_result{end, std::errc()} ||
        std::abs(exponent) > 10'000) {
        return std::nullopt;
    }
    return exponent;
}

// How many letters must be inserted, removed, replaced, or swapped with their neighbour to turn one word into
// the other: a table of distances between their beginnings (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> table(a.size() + 1,
                                                std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                table[i][j] = i + j;
                continue;
            }
            const std::size_t replaced = table[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
            table[i][j] = std::min({table[i - 1][j] + 1, table[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                table[i][j] = std::min(table[i][j], table[i - 2][j - 2] + 1);
            }
        }
    }
    return table[a.size()][b.size()];
}

// Control characters of ASCII, and those of Latin-1.
bool isObeyed(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    return first < 0x20 || first == 0x7f ||
           (first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0);
}

// The first of those that are nearest; empty where none is near.
std::string nearestName(std::string_view name, std::span<const std::string> known) {
    std::string nearest;
    std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = editDistance(name, candidate);
        // A word of which every letter differs is no misspelling, however short it is.
        if (distance < least && distance < std::max(name.size(), candidate.size())) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace

std::string withThousands(std::uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) {
            text += ',';
        }
        text += digits[i];
    }
    return text;
}

std::string fixed(double number, int digits) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, number);
    return text.data();
}

std::string plain(double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.15g", number);
    return text.data();
}

std::string milliseconds(double number) {
    const double size = std::abs(number);
    if (size >= 99.95) {
        return fixed(number, 0);
    }
    return fixed(number, size >= 9.995 ? 1 : size >= 0.9995 ? 2 : size >= 0.09995 ? 3 : 4);
}

std::string byteSize(std::int64_t bytes) {
    constexpr std::array kUnits{"B", "KiB", "MiB", "GiB"};
    auto size = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (std::abs(size) >= 1024 && unit + 1 < kUnits.size()) {
        size /= 1024;
        ++unit;
    }
    const int digits = unit == 0 || std::abs(size) >= 100 ? 0 : std::abs(size) >= 10 ? 1 : 2;
    return fixed(size, digits) + " " + kUnits[unit];
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
    std::string text;
    for (const std::string& word : words) {
        text += &word == words.data() ? "" : separator;
        text += word;
    }
    return text;
}

std::size_t characterLength(std::string_view text) noexcept {
    if (text.empty()) {
        return 0;
    }
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t length = byte(0) < 0x80   ? 1
                               : byte(0) < 0xc2 ? 0  // follows, or is too long for its character
                               : byte(0) < 0xe0 ? 2
                               : byte(0) < 0xf0 ? 3
                               : byte(0) < 0xf5 ? 4
                                                : 0;
    if (length > text.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) {
            return 0;
        }
    }
    // Too long for their characters, surrogates, and beyond the last character.
    const bool isNone = (byte(0) == 0xe0 && byte(1) < 0xa0) ||
                        (byte(0) == 0xed && byte(1) > 0x9f) ||
                        (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
    return isNone ? 0 : length;
}

std::string masked(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = characterLength(text);
        if (length == 0 || isObeyed(text.substr(0, length))) {
            shown += '?';
        } else {
            shown += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return shown;
}

std::string printable(std::string_view word) {
    constexpr std::size_t kMost = 40;
    std::size_t length = std::min(word.size(), kMost);
    // Not within a character.
    while (length < word.size() && length > 0 && (word[length] & 0xc0) == 0x80) {
        --length;
    }
    return masked(word.substr(0, length)) + (length < word.size() ? "..." : "");
}

std::string quotedWord(std::string_view word) {
    std::string quoted(1, '\'');
    quoted += printable(word);
    return quoted += '\'';
}

std::string suggestion(std::string_view name, std::span<const std::string> known,
                       const std::string& quote) {
    const std::string nearest = nearestName(name, known);
    return nearest.empty() ? "; there are " + joined(known, ", ") + "."
                           : "; did you mean " + quote + nearest + quote + "?";
}

std::string unknownNameSentence(std::string_view whatItIs, std::string_view name,
                                std::span<const std::string> known) {
    return "There is no " + std::string(whatItIs) + " " + quotedWord(name) +
           suggestion(name, known, "'");
}

std::optional<std::uint64_t> wholeNumber(std::string_view word) {
    const std::string plain = plainSpelling(word);
    const std::size_t e = std::min(plain.find_first_of("eE"), plain.size());
    std::optional<int> exponent = 0;
    if (e < plain.size()) {
        exponent = exponentOf(std::string_view(plain).substr(e + 1));
    }
    std::string digits = plain.substr(0, e);
    if (const std::size_t point = digits.find('.'); exponent && point < digits.size()) {
        *exponent -= static_cast<int>(digits.size() - point - 1);
        digits.erase(point, 1);
    }
    if (!exponent || digits.empty() ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
        return std::nullopt;
    }
    digits.erase(0, digits.find_first_not_of('0'));
    for (; *exponent < 0 && digits.ends_with('0'); ++*exponent) {
        digits.pop_back();
    }
    if (digits.empty()) {
        return 0;
    }
    constexpr std::size_t kMostDigits = 20;  // of 2^64 - 1
    if (*exponent < 0 || digits.size() + static_cast<std::size_t>(*exponent) > kMostDigits) {
        return std::nullopt;
    }
    digits.append(static_cast<std::size_t>(*exponent), '0');
    std::uint64_t number = 0;
    const char* const end = digits.data() + digits.size();
    const bool fits =
        std::from_chars(digits.data(), end, number) == std::from_chars_result{end, std::errc()};
    return fits ? std::optional(number) : std::nullopt;
}

std::optional<double> finiteNumber(std::string_view word) {
    const std::string plain = plainSpelling(word);
    const char* const end = plain.data() + plain.size();
    double number = 0;
    const bool isNumber =
        fromChars(plain.data(), end, number) == std::from_chars_result{end, std::errc()};
    return isNumber && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string_view withoutBlanks(std::string_view word) {
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = std::min(word.find_first_not_of(kBlanks), word.size());
    return word.substr(begin, word.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace hashphase::demos
