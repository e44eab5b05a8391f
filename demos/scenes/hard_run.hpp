// SPDX-License-Identifier: Zlib
#pragma once

// A hard world over a broadphase, stepped and measured.

#include <demos/scenes/hard_worlds.hpp>
#include <demos/scenes/physics_world.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

/// How a world went over one broadphase.
struct PhysicsOutcome {
    std::string scene;
    std::string broadphase;

    /// The deepest overlap of two bodies in any of the states that were looked at [m].
    double worstPenetration = 0;

    /// By how much the mechanical energy ever exceeded that of the beginning [J]: none of these
    /// worlds is given any.
    double energyDrift = 0;

    /// The number of steps after which all bodies sleep, to the end; -1: never.
    int settleStep = -1;

    /// Bodies asleep, summed over the steps.
    std::uint64_t sleepingBodySteps = 0;

    /// Bullets that came through a wall: at all, where walls are to stop them; without a pair of
    /// the two in that step, where they are to be noticed.
    int tunnelled = 0;

    /// Of places, velocities and activation of all bodies after every step.
    std::uint64_t trajectoryHash = 0;
};

/// How deep bodies are in one another: compares all bodies with all, by Bullet's narrowphase in a dispatcher of its own: the world is
/// not touched, and a pair that its broadphase has lost counts like any other.
class PenetrationMeter {
public:
    /// The deepest overlap of two bodies that may collide and respond, of which one is not static
    /// [m]; 0 where none touch. Cost: the square of the number of bodies.
    [[nodiscard]] double deepest(const WorldContents& contents);

private:
    [[nodiscard]] double depthOf(const btCollisionObject& a, const btCollisionObject& b);

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
};

class HardRun {
public:
    /// Fills a world over that broadphase; its lists are in that order.
    HardRun(const HardWorld& world, const PhysicsBroadphase& broadphase, ListOrder order);

    /// One step of 1/60 s; measures.
    void step();

    /// Of the state after the last step; see stateHash().
    [[nodiscard]] std::uint64_t state() const noexcept { return state_; }
    [[nodiscard]] int sleepingCount() const noexcept { return sleepingCount_; }
    [[nodiscard]] PhysicsWorld& world() noexcept { return world_; }

    /// Of all steps so far.
    [[nodiscard]] const PhysicsOutcome& outcome() const noexcept { return outcome_; }

private:
    [[nodiscard]] double energy() const;
    void watchSleep();
    void watchBullets();

    HardWorld hard_;
    PhysicsWorld world_;
    PenetrationMeter meter_;
    int stepCount_ = 0;
    int movableCount_ = 0;
    int sleepingCount_ = 0;
    double firstEnergy_ = 0;
    std::uint64_t state_ = 0;
    std::vector<btScalar> bulletPlaces_;  // along x, before the step
    PhysicsOutcome outcome_;
};

}  // namespace hashphase::demos
