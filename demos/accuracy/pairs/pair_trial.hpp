// SPDX-License-Identifier: Zlib
#pragma once

// What ways to find pairs get wrong, and what they cost, on one scene that moves.

#include <demos/accuracy/pairs/pair_method.hpp>
#include <demos/report/statistics.hpp>

namespace hashphase::demos {

struct PairTrialPlan {
    int judgedFrames = 4;  // before the times are taken, and as many after them
    int rounds = 60;       // of `framesTogether` frames each, for which a method is timed
    int framesTogether = 1;
};

/// Sums over all judged frames, and times.
struct PairMeasurement {
    int judgedFrames = 0;
    std::uint64_t truePairs = 0;
    std::uint64_t missed = 0;  // overlapping, but not listed
    std::uint64_t extra = 0;   // listed, but not overlapping
    std::optional<double> testsPerFrame;
    std::optional<std::int64_t> bytes;  // of heap after the first judged frames
    std::optional<Spread> time;         // [ms] a frame
};

struct PairTrial {
    std::vector<PairMeasurement> measurements;  // one a method

    // The truth comes from a sweep along one axis; brute force, up to so many objects, judges it.
    static constexpr std::size_t kBruteForceUpTo = 20'000;
    int framesByBruteForce = 0;
    int framesThatDiffer = 0;
};

/// Runs all methods on the scene, which moves on.
[[nodiscard]] PairTrial tryPairs(BoxScene& scene, std::span<const PairMethod> methods,
                                 const PairTrialPlan& plan);

}  // namespace hashphase::demos
