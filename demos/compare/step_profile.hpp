// SPDX-License-Identifier: Zlib
#pragma once

// Where the time of the compared frames' steps goes, told by the same steps taken again: nothing of this is in
// the times of the comparison.

#include <demos/compare/comparison.hpp>

namespace hashphase::demos {

/// So many frames are taken again at most.
inline constexpr int kMostProfiledFrames = 1000;

/// Fills the trial, which is profiled() of the one that was compared, with the broadphases that took part in
/// that, and takes its frames again as far as the time limit allows: as runFrames(), unverified. Records the
/// `steps` that were timed there, and the `zones` of each.
void profileSteps(Trial& trial, const ComparisonSettings& settings, const ComparisonEnd& compared,
                  const std::vector<Contestant>& contestants, Measurements& measured);

}  // namespace hashphase::demos
