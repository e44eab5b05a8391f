// SPDX-License-Identifier: Zlib
#include <tests/viewer/pictures.hpp>

#include <demos/console/result_file.hpp>

#include <gtest/gtest.h>

#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <ostream>
#include <stdexcept>

namespace hashphase::demos {
namespace {

constexpr std::size_t kColours = 3;
constexpr float kVisibleDifference = 16;

/// Of the neighbourhood of three by three, as far as there is one.
std::array<float, kColours> meanAround(const Image& image, int x, int y) {
    std::array<float, kColours> sum{};
    float count = 0;
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.height - 1); ++row) {
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.width - 1);
             ++column) {
            const std::uint8_t* pixel = image.at(column, row);
            for (std::size_t i = 0; i < kColours; ++i) {
                sum[i] += pixel[i];
            }
            ++count;
        }
    }
    for (float& channel : sum) {
        channel /= count;
    }
    return sum;
}

}  // namespace

Image readPng(const std::filesystem::path& path) {
    Image image;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load(path.c_str(), &image.width, &image.height, nullptr, 4), stbi_image_free);
    if (pixels == nullptr) {
        throw std::runtime_error("The picture " + path.string() + ": " + stbi_failure_reason());
    }
    image.pixels.assign(pixels.get(), pixels.get() + std::size_t{4} * image.width * image.height);
    return image;
}

ImageDifference::ImageDifference(const Image& one, const Image& other) {
    if (one.width != other.width || one.height != other.height) {
        return;
    }
    map = {one.width, one.height, {}};
    double sum = 0;
    std::size_t offCount = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x) {
            const auto a = meanAround(one, x, y), b = meanAround(other, x, y);
            float difference = 0;
            for (std::size_t i = 0; i < kColours; ++i) {
                difference = std::max(difference, std::abs(a[i] - b[i]));
                const float shown = std::min(4 * std::abs(a[i] - b[i]), 255.0F);
                map.pixels.push_back(static_cast<std::uint8_t>(shown));
            }
            map.pixels.push_back(255);
            sum += difference;
            offCount += difference > kVisibleDifference ? 1 : 0;
        }
    }
    const double count = std::max(1.0, static_cast<double>(one.width) * one.height);
    mean = sum / count;
    shareOff = static_cast<double>(offCount) / count;
}

void savePng(const std::string& path, const Image& image) {
    ResultFile(path).write([&image](std::ostream& out) { writePng(image, out); });
}

void expectGolden(const std::string& name, const Image& actual) {
    constexpr const char* kRewrite = "HASHPHASE_REWRITE_GOLDEN_PICTURES";
    const std::string golden = HASHPHASE_VIEWER_TESTS "/" + name + ".png";
    if (std::getenv(kRewrite) != nullptr) {
        savePng(golden, actual);
        return;
    }
    const ImageDifference difference(readPng(golden), actual);
    if (!difference.isSeen()) {
        return;
    }
    const std::string wrong =
        HASHPHASE_WRONG_PICTURES "/" + std::filesystem::path(name).filename().string();
    savePng(wrong + "-actual.png", actual);
    if (!difference.map.pixels.empty()) {
        savePng(wrong + "-difference.png", difference.map);
    }
    ADD_FAILURE() << "The picture is another one than " << golden << ": "
                  << 100 * difference.shareOff << " % of its pixels are off, by " << difference.mean
                  << " of 255 on average.\nDrawn: " << wrong << "-actual.png\nDifference: " << wrong
                  << "-difference.png\nIf it is right as drawn, run this test with " << kRewrite
                  << "=1 in the environment, look at the new picture, and commit it.";
}

}  // namespace hashphase::demos
