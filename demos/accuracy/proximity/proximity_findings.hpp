// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/proximity/estimate_formula.hpp>
#include <demos/accuracy/proximity/proximity.hpp>

namespace hashphase::demos {

/// Tables, charts, checks, choices and conclusions.
[[nodiscard]] Findings proximityFindings(std::span<const ProximityResult> results,
                                         std::span<const StatedEstimate> stated);

}  // namespace hashphase::demos
