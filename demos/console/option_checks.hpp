// SPDX-License-Identifier: Zlib
#pragma once

// Checks of option values that CLI11 has none for.

#include <CLI/CLI.hpp>

#include <string>

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

}  // namespace hashphase::demos
