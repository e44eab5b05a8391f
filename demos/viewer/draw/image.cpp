// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/image.hpp>

#include <stb_image.h>
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace hashphase::demos {

namespace {

constexpr int kChannels = 4;

/// What the system says of the last operation, or `otherwise` where it says nothing.
std::string systemFault(const char* otherwise) {
    return errno != 0 ? std::strerror(errno) : otherwise;
}

void writeBytes(void* file, void* bytes, int count) {
    static_cast<std::ofstream*>(file)->write(static_cast<const char*>(bytes), count);
}

constexpr std::size_t kColours = 3;
constexpr float kVisibleDifference = 16;
constexpr double kLargestMean = 1;
constexpr double kLargestShareOff = 0.001;

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

void writePng(const std::filesystem::path& path, const Image& image) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    stbi_write_png_to_func(writeBytes, &file, image.width, image.height, kChannels,
                           image.pixels.data(), kChannels * image.width);
    file.close();
    if (!file) {
        throw DrawError("The picture " + path.string() +
                        " cannot be written: " + systemFault("the disk refuses") + ".");
    }
}

Image readPng(const std::filesystem::path& path) {
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file) {
        throw DrawError("The picture " + path.string() +
                        " cannot be read: " + systemFault("it is no file") + ".");
    }
    Image image;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                              static_cast<int>(bytes.size()), &image.width, &image.height, nullptr,
                              kChannels),
        stbi_image_free);
    if (pixels == nullptr) {
        throw DrawError("The picture " + path.string() + " is no PNG: " + stbi_failure_reason() +
                        ".");
    }
    const std::size_t size = std::size_t{kChannels} * image.width * image.height;
    image.pixels.assign(pixels.get(), pixels.get() + size);
    return image;
}

ImageDifference imageDifference(const Image& one, const Image& other) {
    ImageDifference result;
    if (one.width != other.width || one.height != other.height) {
        return result;
    }
    result.isComparable = true;
    result.map = {one.width, one.height, {}};
    result.map.pixels.reserve(one.pixels.size());
    double sum = 0;
    std::size_t offCount = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x) {
            const auto a = meanAround(one, x, y), b = meanAround(other, x, y);
            float difference = 0;
            for (std::size_t i = 0; i < kColours; ++i) {
                difference = std::max(difference, std::abs(a[i] - b[i]));
                const float shown = std::min(4 * std::abs(a[i] - b[i]), 255.0F);
                result.map.pixels.push_back(static_cast<std::uint8_t>(shown));
            }
            result.map.pixels.push_back(255);
            sum += difference;
            offCount += difference > kVisibleDifference ? 1 : 0;
        }
    }
    const double count = std::max(1.0, static_cast<double>(one.width) * one.height);
    result.mean = sum / count;
    result.shareOff = static_cast<double>(offCount) / count;
    return result;
}

bool looksTheSame(const ImageDifference& difference) {
    return difference.isComparable && difference.mean < kLargestMean &&
           difference.shareOff < kLargestShareOff;
}

}  // namespace hashphase::demos
