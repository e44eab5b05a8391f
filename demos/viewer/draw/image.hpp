// SPDX-License-Identifier: Zlib
#pragma once

// A picture in memory, and as a file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace hashphase::demos {

/// A picture cannot be drawn or written; what() says why, and what to do where there is something.
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

/// Replaces the file. Throws DrawError, naming the path and the fault, when it cannot be written.
void writePng(const std::filesystem::path& path, const Image& image);

}  // namespace hashphase::demos
