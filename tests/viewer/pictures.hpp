// SPDX-License-Identifier: Zlib
#pragma once

// Pictures beside each other; and those that were looked at and found right, in the folder golden/ beside a test.

#include <demos/viewer/draw/image.hpp>

#include <filesystem>
#include <string>

namespace hashphase::demos {

/// As four bytes a pixel. Throws std::runtime_error where there is none.
[[nodiscard]] Image readPng(const std::filesystem::path& path);

/// Replaces the file. Throws InputError if it cannot be written.
void savePng(const std::string& path, const Image& image);

/// How much two pictures differ, as an eye would say: drivers may round in their own way, and move an edge by
/// a part of a pixel. Of pictures after each pixel became the mean of its neighbourhood of three by three. The
/// difference of two pixels is that of the channel that differs most, from 0 to 255.
struct ImageDifference {
    ImageDifference(const Image& one, const Image& other);

    /// Whether two drivers could have drawn them from one Picture: their sizes are equal, less than one part in a
    /// thousand of the pixels is off, and the mean difference is below 1.
    [[nodiscard]] bool isSeen() const {
        return map.pixels.empty() || !(mean < 1) || !(shareOff < 0.001);
    }

    double mean = 0;      // of the differences
    double shareOff = 0;  // of pixels that differ by more than can be overlooked
    Image map;  // the differences, four times as strong, on black; empty where sizes differ
};

[[nodiscard]] inline bool looksTheSame(const Image& one, const Image& other) {
    return !ImageDifference(one, other).isSeen();
}

/// Compares with the picture of that name, "draw/golden/dark_theme"; or replaces it where the variable
/// HASHPHASE_REWRITE_GOLDEN_PICTURES is set.
void expectGolden(const std::string& name, const Image& actual);

}  // namespace hashphase::demos
