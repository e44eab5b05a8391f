// SPDX-License-Identifier: Zlib
#pragma once

// P8: does the broadphase change how bodies move? Worlds over several broadphases are stepped side
// by side and compared bit by bit with the one over btSimpleBroadphase, which is brute force.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/physics/physics_scenes.hpp>
#include <demos/scenes/physics_world.hpp>

#include <cstdint>
#include <span>

namespace hashphase::demos {

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
