// SPDX-License-Identifier: Zlib
#pragma once

// Which objects of a run are recorded, and how large the world is in which they are drawn.

#include <broadphase/aabb.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

struct ReplaySelection {
    std::vector<std::uint32_t> objects;  // by their numbers, in order
    Aabb<float> bounds;                  // finite; lower than upper, or the same
    float typicalEdge = 1;               // the median of the boxes' longest edges; above 0
};

/// At most so many objects: of more, those in a square column around the middle of all, so that few
/// pairs among them and others are lost. The bounds hold the world as far as it is no more than four
/// times as large as what nearly all of the objects take: a few that are far away, or have no end,
/// would leave the others no resolution.
[[nodiscard]] ReplaySelection selectForReplay(std::span<const Aabb<float>> boxes,
                                              const Aabb<float>& world, std::size_t most);

}  // namespace hashphase::demos
