// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// What an update did: how many proxies it touched, and how many it left alone.
struct UpdateCost {
    std::uint32_t changed = 0;  ///< added, moved, regrouped or removed since the last update
    std::uint64_t filed = 0;    ///< written into tables, by queries since the last update too
    std::uint32_t resting = 0;  ///< at rest
    /// The most proxies in one cell. If this is a large part of all, they lie on top of each other, or
    /// GridConfig::cellSize is much too large. Answers stay exact, but take longer.
    std::uint32_t largestCell = 0;
};

}  // namespace hashphase
