// SPDX-License-Identifier: Zlib
#pragma once

// A picture in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

/// Four bytes a pixel (red, green, blue, alpha), row by row from the top, without gaps.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;

    /// Of the pixel in column `x` from the left and row `y` from the top.
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return pixels.data() + 4 * (static_cast<std::size_t>(y) * width + x);
    }

    friend bool operator==(const Image&, const Image&) = default;
};

}  // namespace hashphase::demos
