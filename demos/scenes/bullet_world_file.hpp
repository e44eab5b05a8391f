// SPDX-License-Identifier: Zlib
#pragma once

// Worlds serialised by Bullet (`.bullet` files).

#include <demos/scenes/tell_waiting.hpp>
#include <demos/scenes/world_contents.hpp>

#include <filesystem>
#include <string>

namespace hashphase::demos {

/// A `.bullet` file, read and checked once, of which any number of worlds can be made.
class BulletWorldFile {
public:
    /// Throws InputError that names the path, the byte and the fault; also when this program was
    /// built without Bullet's importer.
    explicit BulletWorldFile(const std::filesystem::path& path, const TellWaiting& tell = {});

    /// Adds what the file holds to the world, and sets the world's gravity and solver as it says.
    /// Throws InputError when no collision object comes of it.
    void fill(WorldContents& contents) const;

    /// What is in the file but does not come into a world, in words; empty for nothing.
    [[nodiscard]] const std::string& omissions() const noexcept { return omissions_; }

private:
    std::string path_;
    std::string bytes_;
    std::string omissions_;
};

}  // namespace hashphase::demos
