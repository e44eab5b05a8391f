// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// What update() did: how many proxies it touched, and how many it left alone.
struct UpdateCost {
    std::uint32_t changed = 0;  ///< added, moved or removed since the last update
    std::uint64_t filed = 0;    ///< written into a table
    std::uint32_t resting = 0;  ///< in the table that was left alone
    /// The most proxies that share a cell. Where this is a large part of all proxies, they lie on top of each
    /// other, or GridConfig::cellSize is much too large for them. Such cells are sorted along an axis, which
    /// keeps answers exact and takes longer.
    std::uint32_t largestCell = 0;
};

}  // namespace hashphase
