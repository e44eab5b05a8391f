// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/report/stopwatch.hpp>

#include <algorithm>

#include <time.h>

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
        return std::min(wall, processorMilliseconds() - processorStart_);
    }

private:
    static double processorMilliseconds() {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
    }

    bool onThreads_;
    double processorStart_ = processorMilliseconds();
    Stopwatch wall_;  // read inside of the other
};

}  // namespace hashphase::demos
