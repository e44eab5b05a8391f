// SPDX-License-Identifier: Zlib
#pragma once

// Files that a user hands in.

#include <cstdint>
#include <filesystem>
#include <string>

namespace hashphase::demos {

/// Of what is read as a whole [bytes].
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

/// Throws InputError, naming the path, where there is no file, a folder, or something that may never
/// end, or never begin: a device, a pipe.
void requireFile(const std::filesystem::path& path);

/// The bytes of the file. Throws InputError, naming the path, as requireFile() does, and when the file
/// cannot be read or is larger than kLargestFile. Memory: the file's size.
[[nodiscard]] std::string readFile(const std::filesystem::path& path);

}  // namespace hashphase::demos
