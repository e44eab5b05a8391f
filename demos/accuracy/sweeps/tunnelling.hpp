// SPDX-License-Identifier: Zlib
#pragma once

// Bullets that fly at walls: a frame in which each bullet touches its wall, at any moment of its step
// as likely as at any other. Who looks at the end of the frame alone sees it as often as
// (thickness + bullet) / step says: that line the measurement must lie on.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/sweeps/sweep_tally.hpp>
#include <demos/scenes/random.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

inline constexpr double kBulletRadius = 0.005;  // [m]

/// Walls of one thickness, and steps of one length.
struct TunnellingPoint {
    double thickness = 0;             // [m]
    double ratio = 0;                 // of the step to thickness + 2 * kBulletRadius
    std::vector<SweepTally> tallies;  // one a method

    /// The share of contacts that still show when the frame ends.
    [[nodiscard]] double detectedInTheory() const { return ratio < 1 ? 1 : 1 / ratio; }
};

/// Walls of one thickness and bullets of one speed, several pairs above each other; anew each frame.
/// Every other wall moves as well, and bullets fly up to 7 degrees aslant.
class BulletsAtWalls {
public:
    static constexpr std::uint32_t kLanes = 8;

    BulletsAtWalls(double thickness, double ratio, Random& random);

    void advance();
    [[nodiscard]] const SweptFrame& frame() const noexcept { return frame_; }

private:
    [[nodiscard]] double drawBelow(double limit);

    Random& random_;
    SweptFrame frame_;
    double unit_;       // along x [m]
    double bullet_;     // [units]
    double thickness_;  // [units]
    double step_;       // [units]
};

struct TunnellingPlan {
    std::vector<double> thicknesses;
    std::vector<double> ratios;
    int frames = 0;  // a point, of as many contacts as there are lanes
};

[[nodiscard]] std::vector<TunnellingPoint> measureTunnelling(const TunnellingPlan& plan,
                                                             std::span<const SweepMethod> methods,
                                                             std::uint64_t seed,
                                                             const TellProgress& tell);

}  // namespace hashphase::demos
