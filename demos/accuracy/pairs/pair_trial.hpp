// SPDX-License-Identifier: Zlib
#pragma once

// What ways to find pairs get wrong, and what they cost, on one scene that moves.

#include <demos/accuracy/pairs/pair_method.hpp>
#include <demos/experiment/measurements.hpp>

namespace hashphase::demos {

struct PairTrialPlan {
    int judgedFrames = 4;  // before the times are taken, and as many after them
    int rounds = 60;       // of `framesTogether` frames each, for which a method is timed
    int framesTogether = 1;
};

/// Runs all methods on the scene, which moves on. Adds to the tables that pairs.sql names, under
/// the number of the trial. The true pairs come from a sweep along one axis; brute force, up to
/// 20,000 objects, judges it.
void tryPairs(std::size_t trial, BoxScene& scene, std::span<const PairMethod> methods,
              const PairTrialPlan& plan, Measurements& measured);

}  // namespace hashphase::demos
