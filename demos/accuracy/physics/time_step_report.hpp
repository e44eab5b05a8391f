// SPDX-License-Identifier: Zlib
#pragma once

// What P7 measured, as a table and as charts.

#include <demos/accuracy/physics/time_step_experiment.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

inline constexpr std::string_view kTimeStepSettings =
    "Bullet in single precision; two simulated seconds, looked at 30 times a second; the time is "
    "that of a simulated second, a real-time factor of 1 being 1,000 ms; lower left is better";

/// "1/60 s"; "1/60 s, 10 iterations".
[[nodiscard]] std::string stepText(const Stepping& stepping);
[[nodiscard]] std::string settingText(const Stepping& stepping);

/// The points of a task in one of the ways that go by smaller steps alone, the longest steps first.
[[nodiscard]] std::vector<const TaskPoint*> bySteps(std::span<const TaskPoint> points,
                                                    const PhysicsTask& task,
                                                    std::string_view way = kSmallerSteps);

/// True where all contestants with canonical lists passed through the same states.
[[nodiscard]] bool isSame(const TaskPoint& point, std::span<const PhysicsContestant> contestants);

/// The root mean square, over the looks, of what theory says a free fall goes wrong by [mm].
[[nodiscard]] double predictedFallError(const Stepping& stepping);

/// A row for every point and measure.
[[nodiscard]] DataTable timeStepTable(std::span<const PhysicsContestant> contestants,
                                      std::span<const TaskPoint> points);

/// For every task its errors against time, contestant by contestant; then way by way.
[[nodiscard]] std::vector<Chart> timeStepCharts(std::span<const PhysicsTask> tasks,
                                                std::span<const PhysicsContestant> contestants,
                                                std::span<const TaskPoint> points);

}  // namespace hashphase::demos
