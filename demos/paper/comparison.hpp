// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hashphase::demos {

enum class Outcome : std::uint8_t {
    holds,
    broken,
    notChecked,  // nothing was compared: no claim either way
};

/// "holds", "BROKEN" or "not checked".
[[nodiscard]] constexpr std::string_view nameOf(Outcome outcome) {
    return outcome == Outcome::holds    ? "holds"
           : outcome == Outcome::broken ? "BROKEN"
                                        : "not checked";
}

/// None where nothing was compared.
[[nodiscard]] constexpr std::optional<bool> whetherItHolds(Outcome outcome) {
    return outcome == Outcome::notChecked ? std::nullopt : std::optional(outcome == Outcome::holds);
}

/// What must be so, and whether it is, as far as it was compared.
struct Comparison {
    std::string claim;
    Outcome outcome = Outcome::notChecked;
    std::string evidence;
};

}  // namespace hashphase::demos
