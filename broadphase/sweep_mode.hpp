// SPDX-License-Identifier: Zlib
#pragma once

// Modes and costs of sweeping proxies.

#include <cstdint>

namespace hashphase {

/// Where to search for proxies that a sweeping proxy passes. All modes except none find the same proxies.
enum class Sweep : std::uint8_t {
    none,       ///< no search: the proxy does not sweep
    box,        ///< the box around its way: for short ways, and ways along an axis
    line,       ///< along its way: for long ways, such as of bullets
    automatic,  ///< line if the way is long along two axes or three, else box
};

/// What sweeps cost in an update.
struct SweepCost {
    std::uint32_t sweeping = 0;        ///< proxies that swept
    std::uint32_t segments = 0;        ///< boxes along their ways that were searched
    std::uint32_t rays = 0;            ///< ways so long that each was searched as a ray
    std::uint64_t boxesTested = 0;     ///< against segments and rays, and with each other
    std::uint64_t contactsTested = 0;  ///< by firstContact(), for all but rays
};

}  // namespace hashphase
