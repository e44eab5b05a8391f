// SPDX-License-Identifier: Zlib
#pragma once

// Figures 13, 14 and 15 of Hastings, Mesit, Guha, "Optimization of Large-Scale, Real-Time
// Simulations by Spatial Hashing", as they are printed: frames a second on a Pentium 4, 3.2 GHz.
//
// Censored  `60+` means at least 60, `<1` below 1. What was measured is not known, so these are
//           texts and never become numbers.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace hashphase::demos {

/// What the paper times apart from everything else, a figure each.
enum class Phase : std::uint8_t { collision, visibility, ai };
inline constexpr std::array kPhases{Phase::collision, Phase::visibility, Phase::ai};

inline constexpr std::array<std::uint32_t, 7> kPrintedObjects{500,    1'000,  2'500, 5'000,
                                                              10'000, 20'000, 50'000};
inline constexpr std::array<double, 5> kPrintedCellSizes{5, 10, 25, 50, 100};  // [m]

/// "The highlighted cells indicate a computation time too slow for real-time applications."
inline constexpr double kRealTimeRate = 20;  // [frames/s]

[[nodiscard]] int figureNumber(Phase phase);             // 13
[[nodiscard]] std::string_view nameOf(Phase phase);      // "collision"
[[nodiscard]] std::string_view scopeOf(Phase phase);     // what is timed today, in a sentence
[[nodiscard]] std::string_view paperScope(Phase phase);  // what the paper says that it timed

/// What is printed for so many objects: with cells of that size [m], or un-optimized where there is
/// none. Empty for what has no place in the figure.
[[nodiscard]] std::string_view printedRate(Phase phase, std::uint32_t objects,
                                           std::optional<double> cellSize);

/// The number that is printed; nothing for a censored one, or none.
[[nodiscard]] std::optional<double> exactRate(std::string_view printed);

/// Whether the paper highlights it as too slow.
[[nodiscard]] bool isTooSlow(std::string_view printed);

}  // namespace hashphase::demos
