// SPDX-License-Identifier: Zlib
#pragma once

// A landscape in which few of many objects move fast: what that costs, and what gets lost.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/sweeps/sweep_tally.hpp>
#include <demos/report/statistics.hpp>
#include <demos/scenes/random.hpp>

namespace hashphase::demos {

/// Boxes of 0.4 to 1.2 m that stand, three for each 16 m x 1 m of ground in 16 m of air, and smaller
/// ones among them that fly, each frame so far in a new direction, on from where they came to.
class FastMovers {
public:
    FastMovers(std::uint32_t objects, std::uint32_t movers, double motion, std::uint64_t seed);

    /// The next frame.
    void advance();
    [[nodiscard]] const SweptFrame& frame() const noexcept { return frame_; }

private:
    void aim(MovingBox<float>& mover);
    [[nodiscard]] Aabb<float> drawBox(float smallest, float largest);

    Random random_;
    SweptFrame frame_;
    float side_;    // of the ground [m]
    float motion_;  // along the ground in a frame [m]
};

struct FastMotion {
    double cells = 0;      // a frame; of 1 m
    int judgedFrames = 0;  // the slower, the less is met in one
};

struct FastMoversPlan {
    std::uint32_t objects = 0;
    std::uint32_t movers = 0;
    std::vector<FastMotion> motions;
    int timedFrames = 0;
};

struct MotionResult {
    double motion = 0;                 // [cells a frame]
    std::vector<SweepTally> tallies;   // one a method
    std::vector<Spread> milliseconds;  // a frame; the same
};

[[nodiscard]] std::vector<MotionResult> measureFastMovers(const FastMoversPlan& plan,
                                                          std::span<const SweepMethod> methods,
                                                          std::uint64_t seed,
                                                          const TellProgress& tell);

}  // namespace hashphase::demos
