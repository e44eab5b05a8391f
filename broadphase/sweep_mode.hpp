// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// Where to look for what a proxy passes.
enum class Sweep : std::uint8_t {
    none,       ///< nowhere: it counts as standing
    box,        ///< in the box around its way: for short ways, and those along an axis
    line,       ///< along its way: for what flies far, like bullets
    automatic,  ///< either, by what is less work
};

/// What sweeps cost in an update.
struct SweepCost {
    std::uint32_t sweeping = 0;        ///< proxies
    std::uint32_t segments = 0;        ///< boxes along their ways that were looked for
    std::uint32_t rays = 0;            ///< ways so long that they were looked for as a whole
    std::uint64_t boxesTested = 0;     ///< against segments and rays, and with each other
    std::uint64_t contactsTested = 0;  ///< by firstContact(), for all but rays
};

}  // namespace hashphase
