// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// The cost of an update, as numbers of proxies.
struct UpdateCost {
    /// Proxies that sweep, or were added, moved, regrouped (setGroups()) or removed since the previous update.
    std::uint32_t changed = 0;
    /// Proxies sorted into cells, also by queries since the previous update.
    std::uint64_t filed = 0;
    /// Proxies at rest after the update, including proxies with slack (GridConfig::slack).
    std::uint32_t resting = 0;
    /// Number of proxies in the fullest cell. If this is a large part of all proxies, the proxies in the cell lie on
    /// top of each other, or GridConfig::cellSize is much too large. Results stay exact, but take longer.
    std::uint32_t largestCell = 0;
};

}  // namespace hashphase
