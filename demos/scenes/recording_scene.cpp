// SPDX-License-Identifier: Zlib
#include <demos/scenes/recording_scene.hpp>

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace hashphase::demos {
namespace {

constexpr std::uint64_t kCountsOffset = 256;
constexpr std::uint64_t kWorldOffset = kCountsOffset + 16;
constexpr std::uint64_t kBoxBytes = 32;
constexpr std::uint64_t kHeaderBytes = kWorldOffset + kBoxBytes;
constexpr std::int32_t kMostFrames = 1'000'000'000;

std::array<float, 8> floatsOfBox(const char* bytes) {
    std::array<float, 8> floats{};
    static_assert(sizeof floats == kBoxBytes);
    std::memcpy(floats.data(), bytes, sizeof floats);
    return floats;
}

}  // namespace

RecordingScene::RecordingScene(const std::filesystem::path& path, std::size_t objects,
                               const TellWaiting& tell)
    : path_(path.string()), file_(openToRead(path)) {
    readHeader();
    if (objects > recordedObjects_) {
        throw InputError(path_ + " holds " + std::to_string(recordedObjects_) +
                         " objects, but --objects asks for " + std::to_string(objects) + ".");
    }
    // The memory is bounded by the file's own size, which readHeader() has compared with the counts.
    const std::size_t played = objects == 0 ? recordedObjects_ : objects;
    boxes_.resize(played);
    raw_.resize(played * kBoxBytes);
    for (int frame = frames_; frame >= 0; --frame) {
        readFrame(frame);
        if (tell) {
            tell("reading, " + std::to_string(frame) + " frames to go");
        }
        for (const Aabb<float>& box : boxes_) {
            bounds_.extend(box);
        }
    }
}

void RecordingScene::advance() {
    if (current_ < frames_) {
        readFrame(++current_);
    }
}

void RecordingScene::rewind() {
    current_ = 0;
    readFrame(current_);
}

void RecordingScene::readHeader() {
    const std::uint64_t size = std::filesystem::file_size(path_);
    if (size < kHeaderBytes) {
        fail(size, "the file ends inside the header of " + std::to_string(kHeaderBytes) + " bytes");
    }
    std::array<std::int32_t, 2> counts{};
    file_.seekg(kCountsOffset);
    file_.read(reinterpret_cast<char*>(counts.data()), sizeof counts);
    const auto [objects, frames] = counts;
    if (!file_ || objects <= 0) {
        fail(kCountsOffset,
             "the object count is " + std::to_string(objects) + ", but must be at least 1");
    }
    if (frames < 0 || frames > kMostFrames) {
        fail(kCountsOffset + 4, "the frame count is " + std::to_string(frames) +
                                    ", but must be between 0 and 1,000,000,000");
    }
    recordedObjects_ = static_cast<std::uint64_t>(objects);
    frames_ = frames;

    // Divided rather than multiplied: hostile counts would overflow the product.
    const std::uint64_t frameBytes = recordedObjects_ * kBoxBytes;
    const std::uint64_t states = static_cast<std::uint64_t>(frames) + 1;
    const std::uint64_t present = size - kHeaderBytes;
    if (present / frameBytes < states) {
        fail(size, "the file ends in state " + std::to_string(present / frameBytes) +
                       ", but must hold " + std::to_string(states) + " states of " +
                       std::to_string(objects) + " objects each");
    }
    if (present != states * frameBytes) {
        fail(kHeaderBytes + states * frameBytes,
             "the recording ends here (" + std::to_string(objects) + " objects, " +
                 std::to_string(frames) + " frames), but the file has more bytes");
    }
}

void RecordingScene::readFrame(int frame) {
    const std::uint64_t start =
        kHeaderBytes + static_cast<std::uint64_t>(frame) * recordedObjects_ * kBoxBytes;
    file_.seekg(static_cast<std::streamoff>(start));
    file_.read(raw_.data(), static_cast<std::streamsize>(raw_.size()));
    if (!file_) {
        fail(start, "reading failed");
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        const std::uint64_t place = start + i * kBoxBytes;
        const std::array<float, 8> floats = floatsOfBox(raw_.data() + i * kBoxBytes);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float low = floats[axis];
            const float high = floats[axis + 4];
            if (!std::isfinite(low) || !std::isfinite(high)) {
                fail(place, "object " + std::to_string(i) + " of state " + std::to_string(frame) +
                                " has a coordinate that is not a finite number");
            }
            if (high < low) {
                fail(place, "object " + std::to_string(i) + " of state " + std::to_string(frame) +
                                " is inverted: its max " + "xyz"[axis] + " is below its min");
            }
            boxes_[i].min()[static_cast<Eigen::Index>(axis)] = low;
            boxes_[i].max()[static_cast<Eigen::Index>(axis)] = high;
        }
    }
}

void RecordingScene::fail(std::uint64_t byte, const std::string& fault) const {
    throw InputError(path_ + ": byte " + std::to_string(byte) + ": " + fault + ".");
}

}  // namespace hashphase::demos
