// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/pairs/cell_size_result.hpp>

namespace hashphase::demos {

/// On what all was measured.
[[nodiscard]] std::string cellSizeSettings();

/// "0.25", "2".
[[nodiscard]] std::string factorText(double factor);

/// The automatic cells against the best fixed ones, population by population.
[[nodiscard]] DataTable regretTable(std::span<const CellCaseResult> results);

/// Heat maps of time and memory, and the regret.
[[nodiscard]] std::vector<Chart> overviewCharts(std::span<const CellCaseResult> results);

/// Of one population: missed pairs against time, and boxes compared by cell size.
[[nodiscard]] std::vector<Chart> caseCharts(const CellCaseResult& result);

}  // namespace hashphase::demos
