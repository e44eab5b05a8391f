// SPDX-License-Identifier: Zlib
#pragma once

// P7: what smaller steps and more solver iterations buy, and that the broadphase does not change
// it.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/physics/physics_tasks.hpp>
#include <demos/scenes/physics_world.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

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

}  // namespace hashphase::demos
