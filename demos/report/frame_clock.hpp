// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/report/stopwatch.hpp>
#include <demos/system/limits.hpp>

#include <algorithm>

namespace hashphase::demos {

/// The time since its creation that went into this thread's work. Two clocks, of which the smaller
/// counts: the processor time leaves out what other programs took meanwhile, the wall time is not
/// lengthened by reading the other clock. Of work on several threads the wall time alone counts.
class FrameClock {
public:
    explicit FrameClock(bool onThreads = false) : onThreads_(onThreads) {}

    [[nodiscard]] double milliseconds() const {
        const double wall = wall_.milliseconds();
        if (onThreads_) {
            return wall;
        }
        return std::min(wall, threadMilliseconds() - processorStart_);
    }

private:
    bool onThreads_;
    double processorStart_ = threadMilliseconds();
    Stopwatch wall_;  // read inside of the other
};

}  // namespace hashphase::demos
