// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/viewer/stage/stage.hpp>

#include <array>
#include <cstdint>

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

}  // namespace hashphase::demos
