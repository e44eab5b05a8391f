// SPDX-License-Identifier: Zlib
#pragma once

// Pictures that were looked at and found right, in the folder golden/ beside a test.

#include <demos/viewer/draw/image.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hashphase::demos {

inline constexpr const char* kRewrite = "HASHPHASE_REWRITE_GOLDEN_PICTURES";

/// Compares with the picture of that name; or replaces it where the variable kRewrite is set.
inline void expectGolden(const std::string& name, const Image& actual) {
    const std::filesystem::path golden =
        std::filesystem::path(HASHPHASE_GOLDEN_PICTURES) / (name + ".png");
    if (std::getenv(kRewrite) != nullptr) {
        writePng(golden, actual);
        return;
    }
    const ImageDifference difference = imageDifference(readPng(golden), actual);
    if (looksTheSame(difference)) {
        return;
    }
    const std::filesystem::path folder = HASHPHASE_WRONG_PICTURES;
    const std::filesystem::path wrong = folder / (name + "-actual.png");
    const std::filesystem::path map = folder / (name + "-difference.png");
    writePng(wrong, actual);
    if (difference.isComparable) {
        writePng(map, difference.map);
    }
    ADD_FAILURE() << "The picture is another one than " << golden << ": "
                  << 100 * difference.shareOff << " % of its pixels are off, by " << difference.mean
                  << " of 255 on average.\nDrawn: " << wrong << "\nDifference: " << map
                  << "\nIf it is right as drawn, run this test with " << kRewrite
                  << "=1 in the environment, look at the new picture, and commit it.";
}

}  // namespace hashphase::demos
