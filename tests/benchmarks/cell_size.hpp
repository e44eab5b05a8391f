// SPDX-License-Identifier: Zlib
#pragma once

#include <tests/benchmarks/measurement.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace hashphase::benchmarks {

inline constexpr std::string_view kCellSizeGroup = "cell size";
inline constexpr std::string_view kAutomaticCells = "cells-auto";

/// How the automatic cell size did against the best fixed one in one case.
struct CellSizeRegret {
    double regret = 0;      // time of the automatic one / time of the best fixed one, less 1
    std::string bestFixed;  // the contestant
};

/// The best fixed one has the lowest median; the regret is the median over the frames of the ratio
/// to it. Nothing for other cases, and where either side was not measured.
[[nodiscard]] std::optional<CellSizeRegret> cellSizeRegret(const CaseResult& result);

}  // namespace hashphase::benchmarks
