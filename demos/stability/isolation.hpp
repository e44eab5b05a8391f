// SPDX-License-Identifier: Zlib
#pragma once

// Runs work that may crash, or never end, in a process of its own, so that either is an outcome and
// harms nobody else.
//
// Threads   The caller's process must have no other threads at work.
// Output    What the work writes to stdout or stderr is caught.

#include <demos/stability/case_tally.hpp>
#include <demos/system/limits.hpp>

#include <functional>

namespace hashphase::demos {

struct IsolationLimits {
    double seconds = 2;  // of processor time, less what LimitPause excludes

    /// Of wall time, for what waits and does not work.
    [[nodiscard]] double wallSeconds() const noexcept { return 300 + 50 * seconds; }
};

/// What work() returns; OutcomeKind::hangs, crashes or, when it throws, wrong, with a note that says
/// how. `whileWaiting` is called some times a second. An interruption ends the work, and its outcome means nothing.
[[nodiscard]] CaseOutcome runIsolated(const std::function<CaseOutcome()>& work,
                                      const IsolationLimits& limits,
                                      const std::function<void()>& whileWaiting = {});

}  // namespace hashphase::demos
