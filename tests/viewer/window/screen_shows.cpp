// SPDX-License-Identifier: Zlib
//
// Usage: screen-shows SCREEN PICTURE X Y
//
// Whether a screen, in the file that Xvfb -fbdir keeps of it, shows a picture (PNG) whose left upper corner is at
// this pixel. Exit status 1 where it does not.

#include <demos/scenes/file_bytes.hpp>
#include <tests/viewer/pictures.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

using hashphase::demos::Image;

// X Window Dump, version 7: 25 numbers, the most significant byte first; then colours of 12 bytes each; then
// rows of pixels, blue, green, red and a byte that says nothing.
class Screen {
public:
    explicit Screen(const std::string& path) : bytes_(hashphase::demos::readFile(path)) {
        if (bytes_.size() < 100 || number(1) != 7 || number(11) != 32 || number(7) != 0) {
            throw std::runtime_error(path + " is no screen of 32 bits a pixel");
        }
    }

    [[nodiscard]] Image cut(int x, int y, int width, int height) const {
        Image image{width, height, {}};
        const std::size_t begin = number(0) + 12 * std::size_t{number(19)};
        for (int row = y; row < y + height; ++row) {
            for (int column = x; column < x + width; ++column) {
                const std::size_t pixel = begin + std::size_t{number(12)} * unsigned(row) +
                                          4 * static_cast<std::size_t>(column);
                for (const std::size_t channel : {2U, 1U, 0U}) {
                    image.pixels.push_back(byte(pixel + channel));
                }
                image.pixels.push_back(255);
            }
        }
        return image;
    }

private:
    [[nodiscard]] std::uint8_t byte(std::size_t place) const {
        return static_cast<std::uint8_t>(bytes_.at(place));
    }
    [[nodiscard]] std::uint32_t number(std::size_t index) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            value = value << 8U | byte(4 * index + i);
        }
        return value;
    }

    std::string bytes_;
};

}  // namespace

int main(int count, char** arguments) {
    using namespace hashphase::demos;
    if (count != 5) {
        std::fputs("Usage: screen-shows SCREEN PICTURE X Y\n", stderr);
        return 2;
    }
    const Image picture = readPng(arguments[2]);
    const Image seen =
        Screen(arguments[1])
            .cut(std::atoi(arguments[3]), std::atoi(arguments[4]), picture.width, picture.height);
    const ImageDifference difference(picture, seen);
    std::printf("mean difference %.3f, %.3f %% off\n", difference.mean, 100 * difference.shareOff);
    return difference.isSeen() ? 1 : 0;
}
