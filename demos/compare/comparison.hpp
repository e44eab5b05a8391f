// SPDX-License-Identifier: Zlib
#pragma once

// Runs a trial and records what each broadphase did: the measurements, before any report of them.

#include <demos/compare/trial.hpp>
#include <demos/compare/verifier.hpp>
#include <demos/console/progress.hpp>
#include <demos/replay/replay_recording.hpp>
#include <demos/report/statistics.hpp>
#include <demos/report/stopwatch.hpp>

#include <optional>
#include <vector>

namespace hashphase::demos {

struct FrameRow {
    int frame = 0;
    bool measured = false;  // false while warming up: verified, but not timed
    double setAabbMs = 0;
    double calculateMs = 0;
    std::optional<double> stepMs;
    FrameVerdict verdict;
};

/// The first pair that a broadphase got wrong.
struct Fault {
    int frame = 0;
    bool missing = false;  // else extra
    PairKey pair = 0;
    Aabb<float> firstBox;
    Aabb<float> secondBox;
};

/// One broadphase's record.
struct Result {
    const BroadphaseKind* kind = nullptr;
    double fillMs = 0;               // creating it and all its proxies
    std::optional<double> removeMs;  // destroying Comparison::objectsRemoved of them at the end
    std::vector<FrameRow> rows;
    std::optional<std::int64_t> memoryBytes;
    std::optional<Fault> firstFault;
};

struct Comparison {
    std::vector<Result> results;
    int warmUpFrames = 0;
    int framesDone = 0;
    std::size_t objectsRemoved = 0;
    bool timeLimitHit = false;
};

struct ComparisonSettings {
    int frames = 0;
    std::optional<double> timeLimit;  // [s]
    ProgressStyle progress = ProgressStyle::kSilent;
    ReplayRecording* replay = nullptr;  // gets the first frames, between what is timed; null: none
};

/// Runs all the broadphases through the frames, one after another in each frame and in an order that
/// rotates, so that none has the machine at its best. Beyond the time limit no frame begins.
[[nodiscard]] Comparison runComparison(Trial& trial,
                                       const std::vector<const BroadphaseKind*>& kinds,
                                       const ComparisonSettings& settings, std::ostream& err);

/// Figures of one record over its measured frames; nothing when there is none.
struct Timing {
    Spread setAabb;
    Spread calculate;
    Spread both;
    std::optional<Spread> step;
};
[[nodiscard]] std::optional<Timing> timingOf(const Result& result);

/// A count over all frames, warm-up included.
struct Tally {
    std::size_t total = 0;
    std::size_t most = 0;  // in a frame
};
[[nodiscard]] Tally tallyOf(const Result& result, std::size_t FrameVerdict::*count);

}  // namespace hashphase::demos
