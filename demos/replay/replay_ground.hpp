// SPDX-License-Identifier: Zlib
#pragma once

// The ground of a recording in a byte a height, for a page to draw.
//
// Lattice  squares, as nearly as the bounds allow: 128 along the longer side of the bounds, seen from above.
// Error    half a step of the heights, which is a 255th of the difference between the lowest and the highest.
// Size     at most 129 x 129 bytes; a third more as Base64 in the page.

#include <demos/report/json_values.hpp>
#include <demos/scenes/terrain.hpp>

#include <broadphase/aabb.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

struct ReplayGround {
    std::size_t columns = 0;            // of points, along x; 0: no ground
    std::size_t rows = 0;               // along z
    float lowest = 0;                   // [m]
    float highest = 0;                  // [m]
    std::vector<std::uint8_t> heights;  // row by row: 0 for the lowest, 255 for the highest
};

/// The ground over the whole of the bounds. None if the function is empty, or the bounds are flat in x or z.
[[nodiscard]] ReplayGround sampleGround(const GroundHeight& heightAt, const Aabb<float>& bounds);

/// As replay_data.js reads it; null for no ground.
[[nodiscard]] Json groundJson(const ReplayGround& ground);

}  // namespace hashphase::demos
