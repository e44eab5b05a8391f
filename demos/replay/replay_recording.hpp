// SPDX-License-Identifier: Zlib
#pragma once

// The first frames of a run, for a page to replay: where all objects are, their pairs, and which of
// these each broadphase got wrong. What is right is told by the caller, from the boxes themselves; the
// recorded boxes are rounded (replay_track.hpp), and only drawn.
//
// Order   for each frame: add() for each broadphase once, in any order; then finishFrame().
// Limits  frames, bytes, objects and pairs end where the settings say; the recording tells all that
//         it leaves out.

#include <demos/replay/replay_ground.hpp>
#include <demos/replay/replay_track.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/page.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct ReplaySettings {
    std::string scene;                     // where the objects come from
    Aabb<float> bounds;                    // what leaves them may be cut off there
    GroundHeight ground;                   // under the objects, within the bounds
    std::vector<std::string> broadphases;  // names
    std::size_t opensOn = 0;               // the broadphase that a page shows first
    std::string noun = "objects";          // what the objects are, in the plural
    bool areSpheres = false;               // the boxes hold spheres
    bool sharesBoxes = true;               // all broadphases see the same boxes; else each its own
    std::size_t frames = 120;              // at most
    std::size_t bytes = 4'900'000;         // of the recording in the page, at most
    std::size_t objects = 40'000;          // at most; of more, those around the middle of all
    std::size_t pairs = 150'000;           // in a frame, at most; of more, none is listed
    std::size_t wrongPairs = 200;          // missing, and as many extra, in a frame, at most
};

/// Which objects of a run are recorded, and how large the world is in which they are drawn.
struct ReplaySelection {
    std::vector<std::uint32_t> objects;  // by their numbers, in order
    Aabb<float> bounds;                  // finite; lower than upper, or the same
    float typicalEdge = 1;               // the median of the boxes' longest edges; above 0
};

/// At most so many objects: of more, those in a square column around the middle of all, so that few
/// pairs among them and others are lost. The bounds hold the world as far as it is no more than four
/// times as large as what nearly all of the objects take: a few that are far away, or have no end,
/// would leave the others no resolution.
[[nodiscard]] ReplaySelection selectForReplay(std::span<const Aabb<float>> boxes,
                                              const Aabb<float>& world, std::size_t most);

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

    [[nodiscard]] const ReplaySettings& settings() const noexcept { return settings_; }

    /// As replay_data.js reads it.
    [[nodiscard]] Json json() const;

private:
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
    [[nodiscard]] std::vector<PairKey> amongRecorded(
        std::span<const PairKey> pairs,
        std::size_t most = std::numeric_limits<std::size_t>::max()) const;
    std::size_t list(std::span<const PairKey> pairs, WrongPairs& wrong) const;
    void describeFirst(const ReplayFrame& frame, WrongPairs& wrong) const;
    void removeLastFrame();
    [[nodiscard]] std::size_t bytes() const;

    ReplaySettings settings_;
    std::size_t frames_ = 0;
    bool isFull_ = false;
    ReplaySelection selection_;
    ReplayGround ground_;
    std::vector<std::uint32_t> placeOf_;  // among the recorded objects, of each object
    std::vector<ReplayTrack> tracks_;     // one, or one a broadphase
    std::vector<WrongPairs> wrong_;       // of each broadphase
};

/// Adds the tab "Replay" to the page, unless no frame was recorded. `framesRun` is how many frames the
/// run had, the recorded ones included.
void addReplayTab(const ReplayRecording& recording, std::size_t framesRun, Page& page);

/// The JavaScript and the style sheet of the tab, as they were when the program was built.
[[nodiscard]] PageScript replayScript();
[[nodiscard]] std::string_view replayStyle();

}  // namespace hashphase::demos
