// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/image.hpp>

#include <stb_image_write.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace hashphase::demos {

void writePng(const std::filesystem::path& path, const Image& image) {
    constexpr int kChannels = 4;
    const auto writeBytes = [](void* file, void* bytes, int count) {
        static_cast<std::ofstream*>(file)->write(static_cast<const char*>(bytes), count);
    };
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    stbi_write_png_to_func(writeBytes, &file, image.width, image.height, kChannels,
                           image.pixels.data(), kChannels * image.width);
    file.close();
    if (!file) {
        throw DrawError("The picture " + path.string() + " cannot be written: " +
                        (errno != 0 ? std::strerror(errno) : "the disk refuses") + ".");
    }
}

}  // namespace hashphase::demos
