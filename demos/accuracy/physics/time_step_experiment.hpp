// SPDX-License-Identifier: Zlib
#pragma once

// P7: what smaller steps and more solver iterations buy, and that the broadphase does not change it.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/physics/task_run.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct TimeStepSettings {
    std::vector<int> substeps;    // of 1/30 s, each with 10 iterations
    std::vector<int> iterations;  // at steps of 1/60 s
    int product = 64;             // of steps in 1/30 s and iterations in each, for all `substeps`
    std::uint64_t seed = 1;
};

/// Ours and btDbvtBroadphase, both with their lists in canonical order and as shipped.
[[nodiscard]] std::vector<PhysicsContestant> timeStepContestants();

/// The ways in which all tasks are tried: Bullet as it is, and with Stepping::keepsEnergy.
inline constexpr std::string_view kSmallerSteps = "smaller steps, 10 iterations each";
inline constexpr std::string_view kKeepingEnergy =
    "smaller steps, 10 iterations each, contacts that keep energy";

/// A task with one setting of the engine, done.
struct TaskPoint {
    const PhysicsTask* task = nullptr;
    std::string way;  // in which accuracy is bought: smaller steps, more iterations
    Stepping stepping;
    std::vector<TaskOutcome> outcomes;  // one a contestant
};

/// All tasks with each of the substeps, in both ways; the first task, the hardest on the solver, with each number
/// of iterations and each way to share the product as well.
[[nodiscard]] std::vector<TaskPoint> runTimeSteps(std::span<const PhysicsTask> tasks,
                                                  std::span<const PhysicsContestant> contestants,
                                                  const TimeStepSettings& settings,
                                                  const TellProgress& tell);

/// What the points show.
[[nodiscard]] Findings judgeTimeSteps(std::span<const PhysicsTask> tasks,
                                      std::span<const PhysicsContestant> contestants,
                                      std::span<const TaskPoint> points);

}  // namespace hashphase::demos
