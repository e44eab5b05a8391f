// SPDX-License-Identifier: Zlib
#pragma once

// What P6 measured, as tables and as charts.

#include <demos/accuracy/origin/origin_experiment.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// How much longer a frame takes than in single precision at the origin [%].
[[nodiscard]] double overheadPercent(const OriginOutcomes& outcomes, std::size_t method);

[[nodiscard]] std::string originSettingsText(const OriginSettings& settings);

/// At the origin and about a thousand, ten thousand, ... metres from it: pairs and rays; then where
/// balls came to rest.
[[nodiscard]] std::vector<DataTable> originTables(std::span<const OriginMethod> methods,
                                                  std::span<const SettleMethod> settleMethods,
                                                  std::span<const OriginPoint> points);

/// All points.
[[nodiscard]] std::vector<Chart> originCharts(std::span<const OriginMethod> methods,
                                              std::span<const SettleMethod> settleMethods,
                                              const OriginSettings& settings,
                                              std::span<const OriginPoint> points);

}  // namespace hashphase::demos
