// SPDX-License-Identifier: Zlib
#pragma once

// What flies fast: bullets at walls, one in Bullet's world as well, and boxes in a landscape.

#include <demos/accuracy/sweeps/sweep_truth.hpp>
#include <demos/scenes/random.hpp>

namespace hashphase::demos {

/// Walls of one thickness [m] and bullets of one speed, several pairs above each other; anew each
/// frame. Each bullet touches its wall, at any moment of its step as likely as at any other: who
/// looks at the end of the frame alone sees it as often as (thickness + bullet) / step says.
/// `ratio` is of the step to that. Every other wall moves as well, and bullets fly up to 7 degrees
/// aslant.
class BulletsAtWalls {
public:
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

/// Bullet's own answer to tunnelling, from end to end: as many spheres of the bullets' size fly at
/// such walls through btDiscreteDynamicsWorld, with its continuous collision detection or without.
/// Returns how many come out on the other side.
inline constexpr int kFlyingBodies = 32;
[[nodiscard]] int countTunnelled(double thickness, double ratio, bool isContinuous, Random& random);

/// A landscape in which few of many objects move fast: boxes of 0.4 to 1.2 m that stand, three for
/// each 16 m x 1 m of ground in 16 m of air, and smaller ones among them that fly, each frame so
/// far in a new direction, on from where they came to.
class FastMovers {
public:
    FastMovers(std::uint32_t objects, std::uint32_t movers, double motion, std::uint64_t seed);

    /// The next frame.
    void advance();
    [[nodiscard]] const SweptFrame& frame() const noexcept { return frame_; }

private:
    [[nodiscard]] Aabb<float> drawBox(float smallest, float largest);

    Random random_;
    SweptFrame frame_;
    float side_;    // of the ground [m]
    float motion_;  // along the ground in a frame [m]
};

}  // namespace hashphase::demos
