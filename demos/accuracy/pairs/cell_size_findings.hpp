// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/pairs/cell_size_result.hpp>

namespace hashphase::demos {

/// Tables, charts, checks, choices and conclusions.
[[nodiscard]] Findings cellSizeFindings(std::span<const CellCaseResult> results);

}  // namespace hashphase::demos
