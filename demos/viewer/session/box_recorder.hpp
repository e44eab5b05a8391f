// SPDX-License-Identifier: Zlib
#pragma once

#include <filesystem>

namespace hashphase::demos {

class Session;

/// Simulates so many frames of the session and writes the boxes of all bodies, of now and of each frame, as a
/// Broadmark recording (recording_scene.hpp). Throws InputError where the file cannot be written, or where
/// bodies come or go meanwhile.
void recordBoxes(Session& session, const std::filesystem::path& path, int frames);

}  // namespace hashphase::demos
