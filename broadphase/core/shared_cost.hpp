// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/query_cost.hpp>

#include <atomic>
#include <cstdint>

namespace hashphase::detail {

/// The sum of what threads add at the same time.
class SharedCost {
public:
    void add(const QueryCost& cost) noexcept {
        rowsVisited_ += cost.rowsVisited;
        boxesTested_ += cost.boxesTested;
        hits_ += cost.hits;
    }

    [[nodiscard]] QueryCost sum() const noexcept { return {rowsVisited_, boxesTested_, hits_}; }

private:
    std::atomic<std::uint64_t> rowsVisited_{0};
    std::atomic<std::uint64_t> boxesTested_{0};
    std::atomic<std::uint64_t> hits_{0};
};

}  // namespace hashphase::detail
