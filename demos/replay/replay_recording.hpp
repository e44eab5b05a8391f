// SPDX-License-Identifier: Zlib
#pragma once

// The first frames of a run, for a page to replay: where all objects are, their pairs, and which of
// these each broadphase got wrong. What is right is told by the caller, from the boxes themselves; the
// recorded boxes are rounded (replay_track.hpp), and only drawn.
//
// Order   for each frame: add() for each broadphase once, in any order; then finishFrame().
// Limits  frames, bytes, objects and pairs end where the settings say; the recording tells all that
//         it leaves out.

#include <demos/replay/replay_track.hpp>
#include <demos/report/json_values.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct ReplaySettings {
    std::string scene;                     // where the objects come from
    Aabb<float> bounds;                    // what leaves them may be cut off there
    std::vector<std::string> broadphases;  // names
    std::string noun = "objects";          // what the objects are, in the plural
    bool areSpheres = false;               // the boxes hold spheres
    bool sharesBoxes = true;               // all broadphases see the same boxes; else each its own
    std::size_t frames = 120;              // at most
    std::size_t bytes = 4'900'000;         // of the recording in the page, at most
    std::size_t objects = 40'000;          // at most; of more, those around the middle of all
    std::size_t pairs = 150'000;           // in a frame, at most; of more, none is listed
    std::size_t wrongPairs = 200;          // missing, and as many extra, in a frame, at most
};

/// What one broadphase had and found in one frame; the pairs sorted.
struct ReplayFrame {
    std::span<const Aabb<float>> boxes;  // as many in all frames
    std::span<const PairKey> exact;      // what overlaps and is allowed
    std::span<const PairKey> missing;    // of the exact ones
    std::span<const PairKey> extra;      // listed but not exact
    std::optional<float> cellSize = {};  // of its finest cells [m], where it has cells
};

class ReplayRecording {
public:
    explicit ReplayRecording(ReplaySettings settings);

    /// Whether another frame would be taken.
    [[nodiscard]] bool isFull() const noexcept { return isFull_; }

    /// Adds what the broadphase of that number saw. Not to be called when full.
    void add(std::size_t broadphase, const ReplayFrame& frame);

    /// Keeps the frame, or leaves it out and is full, where it would take too many bytes.
    void finishFrame();

    [[nodiscard]] std::size_t frameCount() const noexcept { return frames_; }
    [[nodiscard]] std::size_t objectCount() const noexcept { return objectCount_; }
    [[nodiscard]] std::size_t recordedObjectCount() const noexcept { return objects_.size(); }
    [[nodiscard]] const ReplaySettings& settings() const noexcept { return settings_; }

    /// The wrong pairs of a broadphase in all recorded frames.
    [[nodiscard]] std::size_t missingCount(std::size_t broadphase) const;
    [[nodiscard]] std::size_t extraCount(std::size_t broadphase) const;

    /// How many of the recorded objects left the drawn world, or had a NaN.
    [[nodiscard]] std::size_t cutCount() const;

    /// In how many frames there are too many pairs to be listed.
    [[nodiscard]] std::size_t framesWithoutPairs() const;

    /// As replay_data.js reads it.
    [[nodiscard]] Json json() const;

private:
    /// What the broadphases that see the same boxes have in common.
    struct Shared {
        ReplayTrack boxes;
        ReplayPairs pairs;                    // of recorded objects, as places among those
        std::vector<std::size_t> inAll = {};  // pairs of all objects, a number for each frame
    };

    /// Pairs of recorded objects, as places among those.
    struct WrongPairs {
        std::vector<std::size_t> missing;  // a number for each frame
        std::vector<std::size_t> extra;
        std::vector<std::size_t> missingListed;
        std::vector<std::size_t> extraListed;
        std::vector<std::uint32_t> places;   // two for each: frame by frame, the missing ones first
        Json first = nullptr;                // who they are, in words
        std::optional<float> cellSize = {};  // in the last frame that was added
    };

    void begin(std::span<const Aabb<float>> boxes);
    /// As places; nothing where one of them is not recorded.
    [[nodiscard]] std::optional<PairKey> placesOf(PairKey pair) const;
    [[nodiscard]] std::vector<PairKey> amongRecorded(std::span<const PairKey> pairs,
                                                     std::size_t most) const;
    std::size_t list(std::span<const PairKey> pairs, WrongPairs& wrong) const;
    void describeFirst(const ReplayFrame& frame, WrongPairs& wrong) const;
    void removeLastFrame();
    [[nodiscard]] std::size_t bytes() const;

    ReplaySettings settings_;
    std::size_t frames_ = 0;
    std::size_t objectCount_ = 0;
    bool isFull_ = false;
    Aabb<float> bounds_;                  // of what is drawn
    std::vector<std::uint32_t> objects_;  // that are recorded
    std::vector<std::uint32_t> placeOf_;  // among those, of each object
    std::vector<Shared> shared_;          // one, or one a broadphase
    std::vector<WrongPairs> wrong_;       // of each broadphase
    float typicalEdge_ = 1;
};

}  // namespace hashphase::demos
