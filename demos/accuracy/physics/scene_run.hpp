// SPDX-License-Identifier: Zlib
#pragma once

// One scene in many worlds at once, step by step.

#include <demos/accuracy/physics/physics_scenes.hpp>
#include <demos/report/statistics.hpp>
#include <demos/scenes/physics_world.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

/// How a scene went over one broadphase.
struct SceneOutcome {
    Spread stepMs;  // wall time of a step
    int firstDifference =
        -1;           // the first step after which a bit differs from the reference; -1: none
    long asleep = 0;  // bodies asleep, summed over the steps
    int pairs = 0;    // at the end

    [[nodiscard]] bool isSame() const noexcept { return firstDifference < 0; }
};

/// Steps the scene, of that many objects, over each of the broadphases with the lists in that order,
/// all in turn in each step of 1/60 s; compares each with the one at `reference`.
[[nodiscard]] std::vector<SceneOutcome> runScene(const PhysicsScene& scene, std::size_t objects,
                                                 std::uint64_t seed, int steps,
                                                 std::span<const PhysicsBroadphase> broadphases,
                                                 ListOrder order, std::size_t reference);

}  // namespace hashphase::demos
