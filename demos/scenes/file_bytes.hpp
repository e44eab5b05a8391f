// SPDX-License-Identifier: Zlib
#pragma once

// Files that a user hands in.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// Called many times with what is being done for somebody who waits for a file or a scene: "reading frame 3
/// of 100". Empty: nobody waits.
using TellWaiting = std::function<void(std::string_view what)>;

/// Of what is read as a whole [bytes].
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

/// Throws InputError, naming the path, where there is no file, a folder, or something that may never
/// end, or never begin: a device, a pipe.
void requireFile(const std::filesystem::path& path);

/// The file, open. Throws InputError, naming the path, as requireFile() does, and when it cannot be opened.
[[nodiscard]] std::ifstream openToRead(const std::filesystem::path& path);

/// The bytes of the file. Throws InputError, naming the path, as requireFile() does, and when the file
/// cannot be read or is larger than kLargestFile. Memory: the file's size.
[[nodiscard]] std::string readFile(const std::filesystem::path& path);

/// The same of a text, without the byte-order mark that some editors put in front of UTF-8. Throws InputError, too,
/// for a file that is no text in UTF-8; the message names the kind of file if it is known.
[[nodiscard]] std::string readText(const std::filesystem::path& path);

/// Whether the name of the file ends so, in capital letters or small ones: ".bullet".
[[nodiscard]] bool hasExtension(const std::filesystem::path& path, std::string_view extension);

}  // namespace hashphase::demos
