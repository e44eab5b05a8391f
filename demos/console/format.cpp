// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace hashphase::demos {

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

std::string printable(std::string_view word) {
    constexpr std::size_t kMost = 40;
    std::size_t length = std::min(word.size(), kMost);
    // Not within a character.
    while (length < word.size() && length > 0 && (word[length] & 0xc0) == 0x80) {
        --length;
    }
    std::string text(word.substr(0, length));
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return length < word.size() ? text + "..." : text;
}

std::string quotedWord(std::string_view word) {
    std::string quoted(1, '\'');
    quoted += printable(word);
    return quoted += '\'';
}

}  // namespace hashphase::demos
