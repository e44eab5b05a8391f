// SPDX-License-Identifier: Zlib
#pragma once

// Worlds serialised by Bullet (`.bullet` files).

#include <demos/scenes/world_contents.hpp>

#include <filesystem>
#include <string>

namespace hashphase::demos {

/// A `.bullet` file, read and checked once, of which any number of worlds can be made.
class BulletWorldFile {
public:
    /// Throws InputError that names the path, the byte and the fault; also when this program was
    /// built without Bullet's importer.
    explicit BulletWorldFile(const std::filesystem::path& path);

    /// Adds what the file holds to the world, and sets the world's gravity and solver as it says.
    /// Throws InputError when no collision object comes of it.
    void fill(WorldContents& contents) const;

private:
    std::string path_;
    std::string bytes_;
};

}  // namespace hashphase::demos
