// SPDX-License-Identifier: Zlib
#pragma once

// From few to many, in colours that people can tell apart whatever they see of red and green.
//
// After J. R. Nuñez, C. R. Anderton and R. S. Renslow, "Optimizing colormaps with consideration for color vision
// deficiency", 2018 (cividis): its lightness grows evenly.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Red, green and blue, 0 to 255: from dark blue for 0 to yellow for 1. Shares outside are those of the nearer end.
[[nodiscard]] inline std::array<float, 3> sequentialRgb(float share) {
    // At nine even steps; between them, colours are mixed.
    constexpr std::array<std::array<float, 3>, 9> kSteps{{{0, 34, 78},
                                                          {26, 56, 111},
                                                          {67, 78, 108},
                                                          {97, 101, 110},
                                                          {125, 124, 120},
                                                          {156, 149, 119},
                                                          {189, 176, 108},
                                                          {224, 205, 88},
                                                          {254, 232, 56}}};
    const float place = std::clamp(share, 0.0F, 1.0F) * (kSteps.size() - 1);
    const auto lower = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
    const float weight = place - static_cast<float>(lower);
    std::array<float, 3> mixed{};
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        mixed[i] = kSteps[lower][i] + weight * (kSteps[lower + 1][i] - kSteps[lower][i]);
    }
    return mixed;
}

/// The load of a cell that is drawn as full, unless there are fuller ones.
inline constexpr std::uint32_t kFullLoad = 8;

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
