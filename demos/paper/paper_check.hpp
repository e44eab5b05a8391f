// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hashphase::demos {

enum class CheckOutcome : std::uint8_t {
    holds,
    broken,
    notChecked,  // nothing was compared: no claim either way
};

/// "holds", "BROKEN" or "not checked".
[[nodiscard]] constexpr std::string_view nameOf(CheckOutcome outcome) {
    return outcome == CheckOutcome::holds    ? "holds"
           : outcome == CheckOutcome::broken ? "BROKEN"
                                             : "not checked";
}

/// None where nothing was compared.
[[nodiscard]] constexpr std::optional<bool> whetherItHolds(CheckOutcome outcome) {
    return outcome == CheckOutcome::notChecked ? std::nullopt
                                               : std::optional(outcome == CheckOutcome::holds);
}

/// What must be so, and whether it is, as far as it was compared.
struct PaperCheck {
    std::string claim;
    CheckOutcome outcome = CheckOutcome::notChecked;
    std::string evidence;
};

}  // namespace hashphase::demos
