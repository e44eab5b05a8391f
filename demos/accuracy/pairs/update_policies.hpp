// SPDX-License-Identifier: Zlib
#pragma once

// P10: what it saves not to tell the broadphase of every move, and what that gets wrong.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/pairs/pair_trial.hpp>

namespace hashphase::demos {

/// How many of the boxes move, and how far.
struct Motion {
    double share = 1;    // 0 to 1
    double step = 0.02;  // the largest move on an axis in a frame, by the mean edge of 1 m
    bool isTask = true;  // its policies compete as choices

    [[nodiscard]] std::string name() const;  // "5 % move by 2 cm"
};

struct UpdatePlan {
    std::size_t objects = 0;
    std::vector<Motion> motions;  // at least one; those with the step of the first are compared
    PairTrialPlan trial;          // frames are multiples of every period, so that rounds are alike
};

/// When a broadphase is told that a box has moved: every time, as few times as boxes that are grown
/// by a margin allow (btDbvtBroadphase does so by 5 cm), or in every so many frames only.
[[nodiscard]] std::vector<PairMethod> updatePolicies();

/// The experiment, with these policies (update_policies.sql).
[[nodiscard]] Findings measurePolicies(const UpdatePlan& plan, std::span<const PairMethod> policies,
                                       std::uint64_t seed, const TellProgress& tell);

}  // namespace hashphase::demos
