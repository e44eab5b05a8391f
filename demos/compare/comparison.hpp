// SPDX-License-Identifier: Zlib
#pragma once

// Runs a trial and records what each broadphase did: the measurements, before any report of them.

#include <demos/compare/trial.hpp>
#include <demos/compare/verifier.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/time_limit.hpp>
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
    std::optional<double> fillMs;        // creating it and all its proxies
    std::optional<double> leftOutAfter;  // [s]: not filled by then, so it takes no further part
    std::optional<double> removeMs;      // destroying Comparison::objectsRemoved of them at the end
    std::vector<FrameRow> rows;
    std::optional<std::int64_t> memoryBytes;
    std::optional<Fault> firstFault;
};

struct Comparison {
    std::vector<Result> results;  // of all that were asked for
    int warmUpFrames = 0;
    int framesDone = 0;
    std::size_t objectsRemoved = 0;
    bool timeLimitHit = false;
};

struct ComparisonSettings {
    int frames = 0;
    TimeLimit limit{std::nullopt};
    ProgressStyle progress = ProgressStyle::kSilent;
    std::ostream& err;  // for the progress
};

/// Fills all the broadphases, within half of the time that is left, of which each has an even share;
/// leaves out which is not full by then.
[[nodiscard]] Comparison fillBroadphases(Trial& trial,
                                         const std::vector<const BroadphaseKind*>& kinds,
                                         const ComparisonSettings& settings);

/// Those that take part: which were filled.
[[nodiscard]] std::vector<const BroadphaseKind*> contestantsOf(const Comparison& comparison);

/// Runs the contestants through the frames, one after another in each frame and in an order that
/// rotates, so that none has the machine at its best; at last removes objects. Beyond the time limit
/// no frame begins, and nothing is removed. `replay` gets the first frames, between what is timed;
/// null: nobody does.
void runFrames(Trial& trial, const ComparisonSettings& settings, ReplayRecording* replay,
               Comparison& comparison);

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
