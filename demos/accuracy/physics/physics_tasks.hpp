// SPDX-License-Identifier: Zlib
#pragma once

// Tasks for a physics engine of which it is known how they ought to go. After SimBenchmark
// (Kang, Hwangbo and others, ETH Zurich): 666 spheres, elastic 666, bouncing, rolling, free fall.
//
// Truth  the laws of motion, in double precision; for spheres that lie in a box, that no two
//        overlap. The engine steps from moment to moment, so errors that shrink with its step are
//        what is measured.
// Units  metres, seconds, kilograms.

#include <demos/scenes/world_contents.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hashphase::demos {

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

}  // namespace hashphase::demos
