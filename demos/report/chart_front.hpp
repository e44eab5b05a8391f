// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/report/chart.hpp>

#include <vector>

namespace hashphase::demos {

inline constexpr const char* kFrontName = "no point is better in both";

/// The rows of a chart that no other row beats in both x and y (less is better), by x; of equals the
/// first. Rows without two numbers take no part.
[[nodiscard]] std::vector<std::size_t> frontRows(const Chart& chart);

}  // namespace hashphase::demos
