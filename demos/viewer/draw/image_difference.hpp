// SPDX-License-Identifier: Zlib
#pragma once

// How much two pictures differ, as an eye would say: drivers may round in their own way, and move
// an edge by a part of a pixel.

#include <demos/viewer/draw/image.hpp>

namespace hashphase::demos {

/// Of pictures after each pixel became the mean of its neighbourhood of three by three. The
/// difference of two pixels is that of the channel that differs most, from 0 to 255.
struct ImageDifference {
    bool isComparable = false;  // the sizes are equal; otherwise, nothing else is said
    double mean = 0;            // of the differences
    double shareOff = 0;        // of pixels that differ by more than kVisibleDifference
    Image map;                  // the differences, four times as strong, on black
};

inline constexpr int kVisibleDifference = 16;

[[nodiscard]] ImageDifference imageDifference(const Image& one, const Image& other);

/// Whether two drivers could have drawn them from one Picture: less than one part in a thousand of
/// the pixels is off, and the mean difference is below 1.
[[nodiscard]] bool looksTheSame(const ImageDifference& difference);

}  // namespace hashphase::demos
