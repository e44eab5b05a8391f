// SPDX-License-Identifier: Zlib
#pragma once

// Modes and costs of sweeping proxies.

#include <cstdint>

namespace hashphase {

/// How to search for proxies that a sweeping proxy touches. All modes except `none` find the same proxies.
enum class Sweep : std::uint8_t {
    none,       ///< no search: the proxy does not sweep
    box,        ///< search the box around the path: for short paths, and paths along an axis
    line,       ///< search along the path: for long paths, for example of bullets
    automatic,  ///< `line` if the path is long along two or three axes, else `box`
};

/// The cost of sweeps in an update.
struct SweepCost {
    std::uint32_t sweeping = 0;        ///< proxies that swept
    std::uint32_t segments = 0;        ///< searched boxes, each around a path or a part of a path
    std::uint32_t rays = 0;            ///< long paths that were searched as a ray
    std::uint64_t boxesTested = 0;     ///< tests of a box with a segment, a ray or another sweeping box
    std::uint64_t contactsTested = 0;  ///< calls of firstContact(), not counting calls for rays
};

}  // namespace hashphase
