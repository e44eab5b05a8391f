// SPDX-License-Identifier: Zlib
#pragma once

// A task in several worlds at once, with one setting of the engine.

#include <demos/accuracy/physics/physics_tasks.hpp>
#include <demos/report/statistics.hpp>
#include <demos/scenes/physics_world.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Who does the task.
struct PhysicsContestant {
    std::string name;
    PhysicsBroadphase broadphase;
    ListOrder order = ListOrder::asShipped;

    /// Its results are to be those of the first such contestant, to the last bit.
    [[nodiscard]] bool isCanonical() const noexcept {
        return order == ListOrder::canonical || order == ListOrder::canonicalByUniqueId;
    }
};

/// States are looked at so often a simulated second.
inline constexpr int kLooksPerSecond = 30;

/// How the engine steps.
struct Stepping {
    int substeps = 1;  // between two looks
    int iterations = 10;

    /// Only what touches is in contact (setContactProcessingThreshold(0)), and overlap is undone
    /// without adding speed, however small it is (m_splitImpulsePenetrationThreshold above 0).
    bool keepsEnergy = false;

    [[nodiscard]] int stepsPerSecond() const noexcept { return kLooksPerSecond * substeps; }
};

struct TaskOutcome {
    Spread secondMs;             // wall time of a simulated second
    std::vector<double> errors;  // root mean square over the looks, one a measure of the task
    std::uint64_t states = 0;    // of the states of all looks; see stateHash()
};

/// Simulates two seconds: sixty looks, all contestants in turn between two of them.
[[nodiscard]] std::vector<TaskOutcome> runTask(const PhysicsTask& task, const Stepping& stepping,
                                               std::uint64_t seed,
                                               std::span<const PhysicsContestant> contestants);

}  // namespace hashphase::demos
