// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/cell_size.hpp>

namespace hashphase::benchmarks {

std::optional<CellSizeRegret> cellSizeRegret(const CaseResult& result) {
    const ContestantResult* automatic = result.find(kAutomaticCells);
    if (result.group != kCellSizeGroup || automatic == nullptr) {
        return std::nullopt;
    }
    const ContestantResult* best = nullptr;
    for (const ContestantResult& fixed : result.contestants) {
        if (&fixed != automatic && fixed.spread() &&
            (best == nullptr || fixed.spread()->median < best->spread()->median)) {
            best = &fixed;
        }
    }
    if (best == nullptr || !automatic->spread()) {
        return std::nullopt;
    }
    return CellSizeRegret{*speedAgainst(automatic, *best) - 1, best->kind.name};
}

}  // namespace hashphase::benchmarks
