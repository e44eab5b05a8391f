// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/proximity/proximity.hpp>

namespace hashphase::demos {

/// On what all was measured.
inline constexpr const char* kProximitySettings =
    "Agents with boxes of 0.5 m wander over a square by up to 1/50 of the radius on each axis and "
    "frame; each counts four colours, drawn once, among those near it and takes the rarest (at "
    "random, 75 % would be wrong). Time: agents moved in the index and decisions taken, for all; "
    "means of 8 frames in a row, medians of 8 such means.";

/// [ns] an agent and frame.
[[nodiscard]] double nanoseconds(const ProximityResult& result, std::size_t method);

/// Bullet's in the same crowd, where it is measured: it has no cells, so once is enough.
[[nodiscard]] std::optional<double> bulletNanoseconds(std::span<const ProximityResult> results,
                                                      const ProximityCase& crowd);

/// A row for each method of the `shown` ones of `all` results.
[[nodiscard]] DataTable resultTable(std::span<const ProximityResult> all,
                                    std::span<const ProximityResult> shown);

/// Of a crowd: wrong decisions against time.
[[nodiscard]] Chart decisionChart(std::span<const ProximityResult> group, std::size_t number);

/// Recall or precision against the radius in cells, for methods to which that matters.
[[nodiscard]] Chart listChart(std::span<const ProximityResult> group, bool isRecall);

}  // namespace hashphase::demos
