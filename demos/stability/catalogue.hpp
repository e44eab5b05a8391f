// SPDX-License-Identifier: Zlib
#pragma once

// All hard cases.

#include <demos/stability/hard_case.hpp>

#include <span>

namespace hashphase::demos {

/// H1 to H45, in that order.
[[nodiscard]] std::span<const HardCase> hardCases();

}  // namespace hashphase::demos
