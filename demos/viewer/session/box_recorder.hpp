// SPDX-License-Identifier: Zlib
#pragma once

// Writes the boxes of a stage's bodies, frame by frame, as a Broadmark recording (recording_scene.hpp). The file
// takes its place when it is complete (result_file.hpp).

#include <demos/console/result_file.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

class BoxRecorder {
public:
    /// Begins with the stage as it is. Bodies that are farther than kFarthest then, or have no end, are left
    /// out. Throws InputError where the file cannot be written, or nobody is left.
    BoxRecorder(const std::filesystem::path& path, std::string_view title, const Stage& stage,
                int frames);

    /// Adds the frame that has been simulated. Throws InputError where the file cannot be written, and where a
    /// body that was there at the beginning is gone, or farther than kFarthest; nothing can be added then.
    void add(const Stage& stage);

    /// Whether all frames are there, and the file is in its place.
    [[nodiscard]] bool isComplete() const noexcept { return count_ == frames_; }

    /// What is to be said when it is: where it is, and without whom.
    [[nodiscard]] std::string summary() const;
    /// How many frames there are, "3 of 60 frames"; and what is to be said where there will be no more.
    [[nodiscard]] std::string progress() const;
    [[nodiscard]] std::string faultSentence(const std::string& reason) const;
    [[nodiscard]] std::string path() const { return file_.path().string(); }

    static constexpr float kFarthest = 1e6F;  // any coordinate [m]

private:
    [[nodiscard]] std::string leftOutText() const;
    template <class Number>
    void writeNumber(Number value);
    void writeBox(const Aabb<float>& box);
    void writeFrame();
    void putInPlace();

    ResultFile file_;
    int frames_;
    int count_ = 0;                       // of frames after the first state
    std::vector<std::uint32_t> indices_;  // of those that are recorded
    std::uint64_t leftOut_ = 0;
    Aabb<float> world_;
    std::vector<Aabb<float>> boxes_;  // of all, by index
    std::vector<CollisionFilter> filters_;
};

}  // namespace hashphase::demos
