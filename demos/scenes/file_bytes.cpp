// SPDX-License-Identifier: Zlib
#include <demos/scenes/file_bytes.hpp>

#include <demos/scenes/input_error.hpp>

#include <fstream>
#include <iterator>

namespace hashphase::demos {

std::string readFile(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw InputError(path.string() + " is a folder, not a file.");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(path.string() + " cannot be opened for reading.");
    }
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (file.bad()) {
        throw InputError(path.string() + " cannot be read.");
    }
    return bytes;
}

}  // namespace hashphase::demos
