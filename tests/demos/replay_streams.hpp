// SPDX-License-Identifier: Zlib
#pragma once

// Reads a replay's streams again, as their headers describe them.

#include <demos/replay/replay_track.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace hashphase::demos {

/// The samples of all objects, frame by frame; fails the test where the stream does not end with them.
[[nodiscard]] std::vector<std::vector<ReplayTrack::Sample>> readBoxes(
    std::span<const std::uint8_t> stream, std::size_t objects, std::size_t frames);

/// The listed pairs, frame by frame.
[[nodiscard]] std::vector<std::vector<PairKey>> readPairs(std::span<const std::uint8_t> stream,
                                                          std::size_t frames);

/// So many boxes of about a metre in a cube, which drift from frame to frame.
[[nodiscard]] std::vector<std::vector<Aabb<float>>> driftingFrames(std::size_t objects,
                                                                   std::size_t frames);

/// All pairs that overlap, sorted.
[[nodiscard]] std::vector<PairKey> overlappingPairs(std::span<const Aabb<float>> boxes);

}  // namespace hashphase::demos
