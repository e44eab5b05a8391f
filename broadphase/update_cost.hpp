// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// The cost of an update, as numbers of proxies.
struct UpdateCost {
    /// Proxies that sweep, or were added, moved, regrouped (setGroups()) or removed since the last update.
    std::uint32_t changed = 0;
    std::uint64_t filed = 0;    ///< proxies sorted into cells, also by queries before the update
    std::uint32_t resting = 0;  ///< proxies at rest after the update
    /// Number of proxies in the fullest cell. If this is a large part of all proxies, they lie on top of each other,
    /// or GridConfig::cellSize is much too large. Results stay exact, but take longer.
    std::uint32_t largestCell = 0;
};

}  // namespace hashphase
