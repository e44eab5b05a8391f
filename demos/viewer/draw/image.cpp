// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/image.hpp>

#include <stb_image_write.h>

#include <ostream>

namespace hashphase::demos {

void writePng(const Image& image, std::ostream& file) {
    constexpr int kChannels = 4;
    const auto writeBytes = [](void* out, void* bytes, int count) {
        static_cast<std::ostream*>(out)->write(static_cast<const char*>(bytes), count);
    };
    stbi_write_png_to_func(writeBytes, &file, image.width, image.height, kChannels,
                           image.pixels.data(), kChannels * image.width);
}

}  // namespace hashphase::demos
