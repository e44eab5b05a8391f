// SPDX-License-Identifier: Zlib
#pragma once

#include <sys/time.h>

namespace hashphase::demos {

/// While it lives, time does not count: for the truth that answers are compared with. Within
/// runIsolated()'s work, not nested; elsewhere it does nothing.
class LimitPause {
public:
    LimitPause() {
        const itimerval off{};
        setitimer(ITIMER_PROF, &off, &left_);
    }
    LimitPause(const LimitPause&) = delete;
    LimitPause& operator=(const LimitPause&) = delete;
    ~LimitPause() {
        if (left_.it_value.tv_sec != 0 || left_.it_value.tv_usec != 0) {
            setitimer(ITIMER_PROF, &left_, nullptr);
        }
    }

private:
    itimerval left_{};
};

}  // namespace hashphase::demos
