// SPDX-License-Identifier: Zlib
#include <demos/console/number_words.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace hashphase::demos {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kSeparators = ",_'";

// Whether the digits come in groups of three, but for the first, which may be shorter.
bool areGroups(std::string_view text, char separator) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isBetween = (text.size() - i) % 4 == 0;
        const bool isRight = isBetween ? i > 0 && text[i] == separator
                                       : kDigits.find(text[i]) != std::string_view::npos;
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
    const std::size_t separator = whole.find_first_of(kSeparators);
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

}  // namespace

std::string_view withoutBlanks(std::string_view word) {
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = std::min(word.find_first_not_of(kBlanks), word.size());
    return word.substr(begin, word.find_last_not_of(kBlanks) + 1 - begin);
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
    if (!exponent || digits.empty() || digits.find_first_not_of(kDigits) != std::string::npos) {
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
    double number = 0;
    const char* const end = plain.data() + plain.size();
    const bool isNumber =
        std::from_chars(plain.data(), end, number) == std::from_chars_result{end, std::errc()};
    return isNumber && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace hashphase::demos
