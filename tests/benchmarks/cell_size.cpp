// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/cell_size.hpp>

namespace hashphase::benchmarks {

std::optional<CellSizeRegret> cellSizeRegret(const CaseResult& result) {
    const ContestantResult* automatic = result.find(kAutomaticCells);
    if (result.group != kCellSizeGroup || automatic == nullptr) {
        return std::nullopt;
    }
    std::optional<CellSizeRegret> worst;
    for (const ContestantResult& fixed : result.contestants) {
        const std::optional<double> speed =
            &fixed == automatic ? std::nullopt : speedAgainst(automatic, fixed);
        if (speed && (!worst || *speed - 1 > worst->regret)) {
            worst = {*speed - 1, fixed.kind.name};
        }
    }
    return worst;
}

}  // namespace hashphase::benchmarks
