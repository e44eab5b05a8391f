// SPDX-License-Identifier: Zlib
#pragma once

// Boxes from a text file: a line each, `min x y z max x y z`, numbers apart by blanks. Empty lines
// and lines that begin with # are skipped, and so is the byte-order mark of UTF-8.

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/file_bytes.hpp>

#include <filesystem>
#include <string_view>

namespace hashphase::demos {

/// Parses the text. Throws InputError that names the line and column of the first fault: no number,
/// a number that is not finite, too few or too many numbers, min above max, no box at all.
[[nodiscard]] std::vector<Aabb<float>> parseTextBoxes(std::string_view text,
                                                      const TellWaiting& tell = {});

/// The boxes of the file, or InputError with the path in front.
[[nodiscard]] std::vector<Aabb<float>> readTextBoxes(const std::filesystem::path& path,
                                                     const TellWaiting& tell = {});

/// Makes the boxes drift by a tenth of their mean edge a frame at most, inside their common bounds.
[[nodiscard]] BrownianBoxes driftingBoxes(const std::vector<Aabb<float>>& boxes);

}  // namespace hashphase::demos
