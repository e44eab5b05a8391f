// SPDX-License-Identifier: Zlib
#pragma once

// Pictures as PNG files.

#include <demos/viewer/draw/image.hpp>

#include <filesystem>

namespace hashphase::demos {

/// Replaces the file. Throws DrawError, naming the path and the fault, when it cannot be written.
void writePng(const std::filesystem::path& path, const Image& image);

/// Of whatever kind the PNG is, as four bytes a pixel. Throws DrawError, naming the path and the
/// fault, when there is none.
[[nodiscard]] Image readPng(const std::filesystem::path& path);

}  // namespace hashphase::demos
