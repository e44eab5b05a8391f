// SPDX-License-Identifier: Zlib
#pragma once

// The experiments with dynamics. P7: what smaller steps and more solver iterations buy, and that the
// broadphase does not change it. P8: does the broadphase change how bodies move? Worlds over several
// broadphases are stepped side by side and compared bit by bit with the one over btSimpleBroadphase, which
// is brute force.
//
// Units  metres, seconds, kilograms.

#include <demos/accuracy/experiment.hpp>
#include <demos/scenes/physics_world.hpp>

namespace hashphase::demos {

// --- Scenes that are hard on a broadphase, or whose answer is known ------------------------------------

/// A scene that is filled, and then perhaps meddled with before each step.
struct PhysicsScene {
    std::string name;
    void (*fill)(WorldContents& contents, std::size_t objects, std::uint64_t seed);
    std::size_t quickObjects;
    std::size_t fullObjects;
    void (*disturb)(WorldContents& contents, int step) = nullptr;
};

/// Eight: the four worlds of `compare`; spheres in a lattice that fall into a box; balls that
/// bounce for ever; spinning compounds that fall into a heap; a pile out of which bodies are taken
/// and dropped again.
[[nodiscard]] std::vector<PhysicsScene> physicsScenes();

/// A floor whose top is at height 0, and four walls `halfWidth` from the middle.
void addOpenBox(WorldContents& contents, btScalar halfWidth);

/// About so many spheres of 1 m in a cubic lattice of that spacing, the lowest at `height`, each
/// off its place by up to `jitter` along every axis.
void addLattice(WorldContents& contents, std::size_t spheres, btScalar spacing, btScalar height,
                btScalar jitter, std::uint64_t seed);

/// A row of balls of 1 m, 2 m apart, above a plane from which they bounce back without loss. Ball i
/// is body 1 + i and begins at bouncingHeight(i).
void addBouncingBalls(WorldContents& contents, std::size_t balls);
[[nodiscard]] double bouncingHeight(std::size_t ball);

// --- P7: tasks of which it is known how they ought to go -----------------------------------------------
//
// After SimBenchmark (Kang, Hwangbo and others, ETH Zurich): 666 spheres, elastic 666, bouncing, rolling,
// free fall. Truth: the laws of motion, in double precision; for spheres that lie in a box, that no two
// overlap. The engine steps from moment to moment, so errors that shrink with its step are what is measured.

/// An error of the state of a world.
struct PhysicsMeasure {
    std::string name;   // as in files: "penetration"
    std::string title;  // "overlap of a ball"
    std::string unit;   // "mm"; empty for a share
    /// The square of the error in that unit, `seconds` after the start.
    std::function<double(const WorldContents& contents, double seconds)> squaredError;
};

struct PhysicsTask {
    std::string name;   // "drop"
    std::string title;  // "216 spheres dropped into a box"
    std::function<void(WorldContents& contents, std::uint64_t seed)> fill;
    std::vector<PhysicsMeasure> measures;  // the first is what the task is about
};

/// drop, elastic, bounce, roll, fall.
[[nodiscard]] std::vector<PhysicsTask> physicsTasks();

/// Who does the tasks.
struct PhysicsContestant {
    std::string name;
    PhysicsBroadphase broadphase;
    ListOrder order = ListOrder::asShipped;
};

struct TimeStepSettings {
    std::vector<int> substeps;    // of 1/30 s, each with 10 iterations
    std::vector<int> iterations;  // at steps of 1/60 s
    int product = 64;             // of steps in 1/30 s and iterations in each, for all `substeps`
    std::uint64_t seed = 1;
};

/// Ours and btDbvtBroadphase, both with their lists in canonical order and as shipped.
[[nodiscard]] std::vector<PhysicsContestant> timeStepContestants();

/// Does all tasks with each of the substeps, with Bullet as it is and with contacts that keep
/// energy; the first task, the hardest on the solver, with each number of iterations and each way
/// to share the product as well. Says what that shows (time_step.sql).
[[nodiscard]] Findings measureTimeSteps(std::span<const PhysicsTask> tasks,
                                        std::span<const PhysicsContestant> contestants,
                                        const TimeStepSettings& settings, const TellProgress& tell);

// --- P8 ------------------------------------------------------------------------------------------------

struct TrajectorySettings {
    int steps = 900;  // of 1/60 s; 60 or more
    std::uint64_t seed = 1;
    bool isQuick = false;
};

/// Runs all scenes with the lists in each order, and says what that shows (trajectory.sql). Among
/// the broadphases must be btSimpleBroadphase and btDbvtBroadphase.
[[nodiscard]] Findings compareTrajectories(std::span<const PhysicsBroadphase> broadphases,
                                           std::span<const PhysicsScene> scenes,
                                           const TrajectorySettings& settings,
                                           const TellProgress& tell);

}  // namespace hashphase::demos
