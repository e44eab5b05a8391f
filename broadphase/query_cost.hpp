// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// The cost of a query: counts of work, not times.
struct QueryCost {
    std::uint64_t rowsVisited = 0;  ///< rows of cells; for rays, blocks of up to eight boxes
    std::uint64_t boxesTested = 0;  ///< boxes compared with the region
    std::uint64_t hits = 0;         ///< proxies given to the collector

    /// Adds the counts of `other`, to sum the costs of several queries.
    QueryCost& operator+=(const QueryCost& other) noexcept {
        rowsVisited += other.rowsVisited;
        boxesTested += other.boxesTested;
        hits += other.hits;
        return *this;
    }
};

}  // namespace hashphase
