// SPDX-License-Identifier: Zlib
#pragma once

// A whole file in memory.

#include <filesystem>
#include <string>

namespace hashphase::demos {

/// The bytes of the file. Throws InputError, naming the path, when it is no readable file.
[[nodiscard]] std::string readFile(const std::filesystem::path& path);

}  // namespace hashphase::demos
