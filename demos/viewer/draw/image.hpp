// SPDX-License-Identifier: Zlib
#pragma once

// A picture in memory, as a file, and beside another one.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace hashphase::demos {

/// A picture cannot be drawn, written or read; what() says why, and what to do where there is something.
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

/// Of whatever kind the PNG is, as four bytes a pixel. Throws DrawError, naming the path and the
/// fault, when there is none.
[[nodiscard]] Image readPng(const std::filesystem::path& path);

/// How much two pictures differ, as an eye would say: drivers may round in their own way, and move an edge by
/// a part of a pixel. Of pictures after each pixel became the mean of its neighbourhood of three by three. The
/// difference of two pixels is that of the channel that differs most, from 0 to 255.
struct ImageDifference {
    bool isComparable = false;  // the sizes are equal; otherwise, nothing else is said
    double mean = 0;            // of the differences
    double shareOff = 0;        // of pixels that differ by more than can be overlooked
    Image map;                  // the differences, four times as strong, on black
};

[[nodiscard]] ImageDifference imageDifference(const Image& one, const Image& other);

/// Whether two drivers could have drawn them from one Picture: less than one part in a thousand of
/// the pixels is off, and the mean difference is below 1.
[[nodiscard]] bool looksTheSame(const ImageDifference& difference);

}  // namespace hashphase::demos
