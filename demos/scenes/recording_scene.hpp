// SPDX-License-Identifier: Zlib
#pragma once

// Plays a recording of moving boxes in the format of the Broadmark benchmark (`.aabbs`).
//
// Layout, little-endian: two names of 128 bytes; int32 object count, int32 frame count, two int32
// unused; the world box; then the boxes of the initial state and of each frame. A box is min and max,
// four floats each, of which the fourth is padding.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/file_bytes.hpp>

#include <filesystem>
#include <fstream>

namespace hashphase::demos {

class RecordingScene : public BoxScene {
public:
    /// Opens the recording and reads it through once, so that a fault shows before anything runs.
    /// Throws InputError that names the path, the byte and the fault: too short or too long for its
    /// counts, impossible counts, a coordinate that is not finite, min above max. Only the first
    /// `objects` boxes are played; 0 plays all. Memory: one frame.
    RecordingScene(const std::filesystem::path& path, std::size_t objects,
                   const TellWaiting& tell = {});

    /// Past the last frame it stays on it.
    void advance() override;

    /// Back to the initial state, of the file that was opened, whatever has its name by now. Throws as
    /// advance() does.
    void rewind();

    [[nodiscard]] Aabb<float> bounds() const override { return bounds_; }
    [[nodiscard]] std::optional<int> frameLimit() const override { return frames_ + 1; }

private:
    void readHeader();
    void readFrame(int frame);
    [[noreturn]] void fail(std::uint64_t byte, const std::string& fault) const;

    std::string path_;
    std::ifstream file_;
    std::uint64_t recordedObjects_ = 0;
    int frames_ = 0;  // beyond the initial state
    int current_ = 0;
    std::vector<char> raw_;
    Aabb<float> bounds_;
};

}  // namespace hashphase::demos
