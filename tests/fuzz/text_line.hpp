// SPDX-License-Identifier: Zlib
#pragma once

// The naive reader of a line of boxes.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

namespace hashphase::test {

/// What one line of text holds by a slow look: a box, nothing, or a fault; undecided where numbers
/// are so small or so many digits long that readers may differ.
struct TextLine {
    bool isBox = false;
    bool isFaulty = false;
    bool isUndecided = false;
    std::array<float, 6> numbers{};
};

inline bool looksLikeNumber(const std::string& word) {
    std::size_t i = word[0] == '-' ? 1 : 0;
    std::size_t digits = 0;
    for (; i < word.size() && (std::isdigit(static_cast<unsigned char>(word[i])) || word[i] == '.');
         ++i) {
        digits += word[i] == '.' ? 0 : 1;
    }
    const std::string mantissa = word.substr(0, i);
    if (digits == 0 || std::count(mantissa.begin(), mantissa.end(), '.') > 1) {
        return false;
    }
    if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
        i += i + 1 < word.size() && (word[i + 1] == '-' || word[i + 1] == '+') ? 2 : 1;
        const std::size_t exponent = i;
        while (i < word.size() && std::isdigit(static_cast<unsigned char>(word[i]))) {
            ++i;
        }
        return i == word.size() && i > exponent;
    }
    return i == word.size();
}

inline TextLine readTextLine(const std::string& text) {
    TextLine line;
    if (!text.empty() && text[0] == '#') {
        return line;
    }
    std::string blanks = text;
    for (char& letter : blanks) {
        letter = letter == '\t' || letter == '\r' ? ' ' : letter;
    }
    std::size_t count = 0;
    for (std::size_t at = blanks.find_first_not_of(' '); at != std::string::npos;) {
        const std::size_t end = std::min(blanks.find(' ', at), blanks.size());
        const std::string word = blanks.substr(at, end - at);
        at = blanks.find_first_not_of(' ', end);
        if (word.find('\0') != std::string::npos || !looksLikeNumber(word) || count == 6) {
            line.isFaulty = true;
            return line;
        }
        const float number = std::strtof(word.c_str(), nullptr);
        line.isUndecided = line.isUndecided || std::abs(number) < 2e-38F || word.size() > 60;
        line.isFaulty = line.isFaulty || !(std::abs(number) <= 1e30F);
        line.numbers[count++] = number;
    }
    line.isBox = count > 0;
    for (std::size_t axis = 0; axis < 3 && count == 6; ++axis) {
        line.isFaulty = line.isFaulty || line.numbers[axis + 3] < line.numbers[axis];
    }
    line.isFaulty = line.isFaulty || (count > 0 && count < 6);
    return line;
}

}  // namespace hashphase::test
