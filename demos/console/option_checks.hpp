// SPDX-License-Identifier: Zlib
#pragma once

// Checks of option values that CLI11 has none for.

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

namespace hashphase::demos {

/// What is wrong with a number of seconds; empty when it is above 0. CLI11's own check lets NaN
/// through.
[[nodiscard]] inline std::string positiveSecondsFault(const std::string& text) {
    double seconds = 0;
    if (!CLI::detail::lexical_cast(text, seconds) || !(seconds > 0)) {
        return "'" + text + "' is no number of seconds above 0";
    }
    return {};
}

/// What is wrong with a seed; empty when it is one. CLI11's own check answers with a range of 300
/// digits, and takes what is too large.
[[nodiscard]] inline std::string seedFault(const std::string& text) {
    std::uint64_t seed = 0;
    const char* const end = text.data() + text.size();
    if (std::from_chars(text.data(), end, seed) != std::from_chars_result{end, std::errc()}) {
        return "'" + text + "' is no seed, which is a whole number from 0 to 2^64 - 1";
    }
    return {};
}

}  // namespace hashphase::demos
