// SPDX-License-Identifier: Zlib
#pragma once

// Numbers as people type them.
//
// Separators  of thousands: ',', '_' or '\'', one of them throughout, between groups of three digits
// Blanks      around the number do not matter

#include <cstdint>
#include <optional>
#include <string_view>

namespace hashphase::demos {

/// The whole number: "100000", "100,000", "1e5", "2.5e3", "+7". Exact; nothing for what is none, is
/// negative, or is beyond 2^64 - 1.
[[nodiscard]] std::optional<std::uint64_t> wholeNumber(std::string_view word);

/// The number, nearest double; nothing for what is none, is not finite, or is beyond 1.8e308.
[[nodiscard]] std::optional<double> finiteNumber(std::string_view word);

/// The word without the blanks around it.
[[nodiscard]] std::string_view withoutBlanks(std::string_view word);

}  // namespace hashphase::demos
