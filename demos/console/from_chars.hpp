// SPDX-License-Identifier: Zlib
#pragma once

// std::from_chars() of floating point, also by a standard library that has it for integers alone (LLVM's before
// version 20).

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <system_error>

namespace hashphase::demos {

/// As std::from_chars(): what it parses, where it ends, and why it fails. In the locale "C", which is a
/// program's until it chooses another one.
template <std::floating_point Number>
[[nodiscard]] std::from_chars_result fromChars(const char* begin, const char* end, Number& value) {
    if constexpr (requires { std::from_chars(begin, end, value); }) {
        return std::from_chars(begin, end, value);
    } else {
        // strtod() would also pass over blanks, and read another sign and hexadecimal digits.
        const std::string text(
            begin, std::find_if(begin, end, [](char c) { return c == 'x' || c == 'X'; }));
        const std::size_t first = text.starts_with('-') ? 1 : 0;
        if (text.find_first_of(" \t\n\v\f\r+-", first) == first) {
            return {begin, std::errc::invalid_argument};
        }
        char* parsed = nullptr;
        errno = 0;
        Number number = 0;
        if constexpr (std::same_as<Number, float>) {
            number = std::strtof(text.c_str(), &parsed);
        } else {
            number = std::strtod(text.c_str(), &parsed);
        }
        if (parsed == text.c_str()) {
            return {begin, std::errc::invalid_argument};
        }
        const char* const after = begin + (parsed - text.c_str());
        if (errno == ERANGE && (std::isinf(number) || number == 0)) {  // and not denormal
            return {after, std::errc::result_out_of_range};
        }
        value = number;
        return {after, {}};
    }
}

}  // namespace hashphase::demos
