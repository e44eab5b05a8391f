// SPDX-License-Identifier: Zlib
#pragma once

// What is asked about a stage: one body, and all pairs.

#include <demos/viewer/stage/stage.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

/// What there is to know about one body.
struct InfoCard {
    std::uint32_t index = 0;
    StageBody body;
    std::array<std::int64_t, 3> cell{};  // of its middle
    std::uint64_t load = 0;              // bodies whose boxes touch that cell
    std::uint64_t neighbours = 0;  // other bodies whose boxes are within the radius of its middle
    std::uint64_t candidates = 0;  // other bodies whose boxes touch its box
    float radius = 0;              // [m]
};

/// Asks the grid about the body, which is there. Cost: three small queries.
[[nodiscard]] InfoCard infoCard(const Stage& stage, const Grid<float>& grid, std::uint32_t index,
                                float radius);

/// The pairs that a stage's broadphase has found in the last frame, and the exact ones; all sorted.
struct PairCheck {
    std::vector<PairKey> exact;
    std::vector<PairKey> missing;  // overlap and are not listed: wrong answers
    std::vector<PairKey> extra;    // are listed and do not overlap: they cost time
};

/// Cost: the boxes are sorted along one axis.
[[nodiscard]] PairCheck checkPairs(const Stage& stage);

}  // namespace hashphase::demos
