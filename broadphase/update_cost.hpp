// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// The work of an update, as numbers of proxies.
struct UpdateCost {
    /// Proxies that sweep, or were added, moved, regrouped or removed since the last update.
    std::uint32_t changed = 0;
    std::uint64_t filed = 0;    ///< written into tables, also by queries since the last update
    std::uint32_t resting = 0;  ///< at rest after the update
    /// Number of proxies in the fullest cell. If this is a large part of all proxies, they lie on top of each other,
    /// or GridConfig::cellSize is much too large. Results stay exact, but take longer.
    std::uint32_t largestCell = 0;
};

}  // namespace hashphase
