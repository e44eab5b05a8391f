// SPDX-License-Identifier: Zlib
#pragma once

// P1: ways to know what fast objects touch during a frame, between where they are when it begins
// and where they are when it ends; who sees it, and what seeing costs.

#include <broadphase/moving_box.hpp>
#include <demos/accuracy/exact_entry.hpp>
#include <demos/accuracy/experiment.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <demos/scenes/random.hpp>

#include <array>

namespace hashphase::demos {

/// Objects of one frame. The first `movers` may move while it lasts; the others never do.
struct SweptFrame {
    std::vector<MovingBox<float>> objects;
    std::uint32_t movers = 0;

    /// By axis: all coordinates are multiples of it, at the start and at the end of the frame, and
    /// below 2^24 of them. So no coordinate is rounded.
    std::array<float, 3> unit{kUnit, kUnit, kUnit};  // [m]

    static constexpr float kUnit = 0x1p-10F;
};

/// The box at the end of the frame.
[[nodiscard]] inline Aabb<float> endBox(const MovingBox<float>& moving) {
    return moving.box.translated(moving.displacement);
}

/// The box around the way. Nothing is rounded in these scenes.
[[nodiscard]] inline Aabb<float> wayBox(const MovingBox<float>& moving) {
    return moving.box.merged(endBox(moving));
}

/// When the two objects of the frame touch first, as a share of the frame; nothing when they never
/// do. Throws std::logic_error for coordinates that are no multiples of the frame's unit.
[[nodiscard]] std::optional<Fraction> exactContact(const SweptFrame& frame, std::uint32_t a,
                                                   std::uint32_t b);

struct SweepTruth {
    std::vector<PairKey> contacts;  // that begin during the frame, of one mover at least; sorted
    std::vector<Fraction> moments;  // when each begins
    std::vector<PairKey>
        older;  // that touch when the frame begins, found in the one before; sorted
};

/// What is really touched, and when: in integers, so nothing is rounded, and of all pairs. It shares no
/// code with the library.
[[nodiscard]] SweepTruth findTruth(const SweptFrame& frame);

// --- Methods ---------------------------------------------------------------------------------------

/// What a frame cost, over all movers.
struct SweepWork {
    std::uint64_t cells = 0;  // visited
    std::uint64_t tests = 0;  // of two boxes, or a box and a way
};

/// One way at work on one scene.
struct SweepFinder {
    /// A frame: takes the movers as they are now, and finds the pairs.
    std::function<void(const SweptFrame&)> step;

    /// Appends the pairs that the last step left, in any order, those among others than movers too.
    /// Returns what it cost, where that is counted.
    std::function<std::optional<SweepWork>(std::vector<PairKey>&)> listPairs;

    /// When two objects touch first.
    std::function<std::optional<double>(const MovingBox<float>&, const MovingBox<float>&)>
        contactTime = firstContact<float>;
};

/// misses_nothing   promises every pair that touches
/// invents_nothing  promises that the pairs it lists touch
/// exact            both
/// compared         with the others that are, frame by frame
/// discrete         looks at the end of the frame alone
/// tells_time       of contacts
///
/// Those of the paper are slow, and take part in every so manieth frame of many.
using SweepMethod = Method<SweepFinder(const SweptFrame& first)>;

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

// --- Scenes: bullets at walls, one in Bullet's world as well, and boxes in a landscape --------------------

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
