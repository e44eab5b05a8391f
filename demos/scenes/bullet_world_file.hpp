// SPDX-License-Identifier: Zlib
#pragma once

// Worlds serialised by Bullet (`.bullet` files), and a check of their outer shape: Bullet's importer trusts every
// count and length that it reads, so a truncated or damaged file would crash it.

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/world_contents.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// Says what is wrong with the bytes of a `.bullet` file and at which byte; empty when the header is
/// one, every chunk lies within the file and fits its type, names end, the type table (DNA) is whole,
/// and at least one collision object is present. Cost: one pass.
[[nodiscard]] std::string bulletFileFault(std::string_view bytes);

/// What Bullet's importer passes over, in words: "1 multi-body and 2 soft bodies"; empty for nothing.
/// There must be no fault.
[[nodiscard]] std::string bulletFileOmissions(std::string_view bytes);

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
