// SPDX-License-Identifier: Zlib
#pragma once

// The hard cases by what they are about, a file each.

#include <demos/stability/scene.hpp>

#include <span>

namespace hashphase::demos {

[[nodiscard]] std::span<const HardCase> numberCases();    // what is no number, or too large for one
[[nodiscard]] std::span<const HardCase> borderCases();    // borders of cells
[[nodiscard]] std::span<const HardCase> roundingCases();  // numbers that are rounded
[[nodiscard]] std::span<const HardCase> rayCases();       // rays
[[nodiscard]] std::span<const HardCase> longRayCases();   // rays through many cells, or too long
[[nodiscard]] std::span<const HardCase> sweepCases();     // what moves fast
[[nodiscard]] std::span<const HardCase> sizeCases();      // sizes that differ, cells, keys
[[nodiscard]] std::span<const HardCase> crowdCases();     // many at one place
[[nodiscard]] std::span<const HardCase> churnCases();     // changes, by a hair and of everything
[[nodiscard]] std::span<const HardCase> repeatCases();    // the same on every machine
[[nodiscard]] std::span<const HardCase> groundCases();    // terrain
[[nodiscard]] std::span<const HardCase> viewCases();      // cameras and dragged rectangles
[[nodiscard]] std::span<const HardCase> proximityCases();  // who is near, and nobody
[[nodiscard]] std::span<const HardCase> rollbackCases();   // going back in time

}  // namespace hashphase::demos
