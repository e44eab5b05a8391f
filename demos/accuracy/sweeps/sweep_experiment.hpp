// SPDX-License-Identifier: Zlib
#pragma once

// P1: ways to know what fast objects touch during a frame, between where they are when it begins
// and where they are when it ends; who sees it, and what seeing costs.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/sweeps/sweep_truth.hpp>

#include <functional>
#include <memory>
#include <string>

namespace hashphase::demos {

/// What a frame cost, over all movers.
struct SweepWork {
    std::uint64_t cells = 0;  // visited
    std::uint64_t tests = 0;  // of two boxes, or a box and a way
};

/// One way at work on one scene.
class SweepFinder {
public:
    SweepFinder() = default;
    SweepFinder(const SweepFinder&) = delete;
    SweepFinder& operator=(const SweepFinder&) = delete;
    virtual ~SweepFinder() = default;

    /// A frame: takes the movers as they are now, and finds the pairs.
    virtual void step(const SweptFrame& frame) = 0;

    /// Appends the pairs that the last step left, in any order, those among others than movers too.
    /// Returns what it cost, where that is counted.
    virtual std::optional<SweepWork> listPairs(std::vector<PairKey>& pairs) const = 0;
};

struct SweepMethod {
    std::string name;
    std::string origin;  // "ours", "paper", "bullet"
    std::function<std::unique_ptr<SweepFinder>(const SweptFrame& first)> make;
    bool missesNothing = true;   // promises every pair that touches
    bool inventsNothing = true;  // promises that the pairs it lists touch
    bool isDiscrete = false;     // looks at the end of the frame alone
    int oneFrameIn = 1;          // slow ones take part in every so manieth frame of many

    /// When two objects touch first, of methods that say.
    std::function<std::optional<double>(const MovingBox<float>&, const MovingBox<float>&)>
        contactTime = {};

    [[nodiscard]] bool isExact() const noexcept { return missesNothing && inventsNothing; }
};

/// Grid, Sweeps and Pairs; those on the paper's grid; btDbvtBroadphase.
[[nodiscard]] std::vector<SweepMethod> sweepMethods();

struct FastMotion {
    double cells = 0;      // a frame; of 1 m
    int judgedFrames = 0;  // the slower, the less is met in one
};

/// How much is measured.
struct SweepPlan {
    std::vector<double> thicknesses;  // of walls [m]
    std::vector<double> ratios;       // of the bullets' steps to wall and bullet
    int wallFrames = 0;               // of each wall and ratio
    int bodyRounds = 0;               // of kFlyingBodies in Bullet's world, at the same
    std::uint32_t objects = 0;
    std::uint32_t movers = 0;
    std::vector<FastMotion> motions;
    int timedFrames = 0;
};

/// Measures, and says what it shows (sweeps.sql).
[[nodiscard]] Findings findSweeps(const SweepPlan& plan, std::uint64_t seed,
                                  std::span<const SweepMethod> methods, const TellProgress& tell);

}  // namespace hashphase::demos
