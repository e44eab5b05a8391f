// SPDX-License-Identifier: Zlib
#pragma once

// A picture in memory, and as a file.

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <stdexcept>
#include <vector>

namespace hashphase::demos {

/// A picture cannot be drawn; what() says why, and what to do where there is something.
struct DrawError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

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

/// The bytes of a .png file, which must be open in binary mode.
void writePng(const Image& image, std::ostream& file);

}  // namespace hashphase::demos
