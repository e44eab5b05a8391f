// SPDX-License-Identifier: Zlib
#pragma once

// Runs a trial and records what each broadphase did, as rows that compare.sql reports.

#include <demos/compare/trial.hpp>
#include <demos/compare/verifier.hpp>
#include <demos/console/progress.hpp>
#include <demos/experiment/measurements.hpp>
#include <demos/replay/replay_recording.hpp>
#include <demos/report/time_limit.hpp>

#include <optional>
#include <vector>

namespace hashphase::demos {

/// A broadphase that was asked for.
struct Contestant {
    const BroadphaseKind* kind = nullptr;
    std::optional<double> fillMs;        // creating it and all its proxies
    std::optional<double> leftOutAfter;  // [s]: not filled by then, so it takes no further part
    Verifier verifier;
    bool isWrong = false;  // missed or invented a pair
};

struct ComparisonSettings {
    int frames = 0;
    TimeLimit limit{std::nullopt};
    ProgressStyle progress = ProgressStyle::kSilent;
    std::ostream& err;  // for the progress
};

/// How a comparison ended.
struct ComparisonEnd {
    int warmUpFrames = 0;  // verified, but not timed
    int framesDone = 0;
    bool isStopped = false;           // before its last frame, as the time limit was over
    std::size_t objectsToRemove = 0;  // at last, of each
};

/// Fills all the broadphases, within half of the time that is left, of which each has an even share;
/// leaves out which is not full by then.
[[nodiscard]] std::vector<Contestant> fillBroadphases(
    Trial& trial, const std::vector<const BroadphaseKind*>& kinds,
    const ComparisonSettings& settings);

/// Runs those that were filled through the frames, one after another in each frame and in an order that
/// rotates, so that none has the machine at its best; at last removes objects. Beyond the time limit
/// no frame begins, and nothing is removed. `replay` gets the first frames, between what is timed;
/// null: nobody does.
[[nodiscard]] ComparisonEnd runFrames(Trial& trial, const ComparisonSettings& settings,
                                      std::vector<Contestant>& contestants, ReplayRecording* replay,
                                      Measurements& measured);

}  // namespace hashphase::demos
