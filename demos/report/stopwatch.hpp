// SPDX-License-Identifier: Zlib
#pragma once

#include <chrono>

namespace hashphase::demos {

/// Wall time since its creation.
class Stopwatch {
public:
    [[nodiscard]] double milliseconds() const {
        return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace hashphase::demos
