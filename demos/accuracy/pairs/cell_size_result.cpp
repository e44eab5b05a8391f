// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/cell_size_result.hpp>

namespace hashphase::demos {

std::optional<double> CellCaseResult::nanosecondsOf(std::size_t method) const {
    const std::optional<Spread>& time = trial.measurements[method].time;
    return time ? std::optional(time->median * 1e6 / static_cast<double>(objects)) : std::nullopt;
}

std::optional<double> CellCaseResult::bytesPerObject(std::size_t method) const {
    const std::optional<std::int64_t>& bytes = trial.measurements[method].bytes;
    return bytes ? std::optional(static_cast<double>(*bytes) / static_cast<double>(objects))
                 : std::nullopt;
}

std::optional<std::size_t> CellCaseResult::automatic() const {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].isAutomatic && nanosecondsOf(i)) {
            return i;
        }
    }
    return std::nullopt;
}

std::optional<std::size_t> CellCaseResult::bestFixed() const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].isFixed() && nanosecondsOf(i) &&
            (!best || *nanosecondsOf(i) < *nanosecondsOf(*best))) {
            best = i;
        }
    }
    return best;
}

std::optional<std::size_t> CellCaseResult::bullet() const {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].pairs.origin == kOfBullet && nanosecondsOf(i)) {
            return i;
        }
    }
    return std::nullopt;
}

std::optional<double> CellCaseResult::regret() const {
    const auto ours = automatic();
    const auto best = bestFixed();
    if (!ours || !best) {
        return std::nullopt;
    }
    return *nanosecondsOf(*ours) / *nanosecondsOf(*best) - 1;
}

}  // namespace hashphase::demos
