// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/png.hpp>

#include <demos/viewer/draw/draw_error.hpp>

#include <stb_image.h>
#include <stb_image_write.h>

#include <cerrno>
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

}  // namespace hashphase::demos
