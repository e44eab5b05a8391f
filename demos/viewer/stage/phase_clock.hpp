// SPDX-License-Identifier: Zlib
#pragma once

// Times the phases of a frame, which follow each other without a gap.

#include <algorithm>
#include <chrono>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

struct PhaseTime {
    std::string_view name;
    double milliseconds = 0;
};

class PhaseClock {
public:
    /// Begins a frame, of which nothing is known yet.
    void begin() {
        times_.clear();
        last_ = Clock::now();
    }

    /// What has passed since begin() or the last end() belongs to this phase, whose name lives as long as
    /// the program. One that ends twice in a frame has the sum.
    void end(std::string_view phase) {
        const double milliseconds = skip();
        add(phase, milliseconds);
    }

    /// What has passed since then belongs to nobody, or to those who are told by add(). Returns it [ms].
    double skip() {
        const Clock::time_point before = std::exchange(last_, Clock::now());
        return std::chrono::duration<double, std::milli>(last_ - before).count();
    }

    /// Adds what somebody else has measured.
    void add(std::string_view phase, double milliseconds) {
        const auto known = std::ranges::find(times_, phase, &PhaseTime::name);
        if (known != times_.end()) {
            known->milliseconds += milliseconds;
        } else {
            times_.push_back({phase, milliseconds});
        }
    }

    /// In the order in which they first ended.
    [[nodiscard]] std::span<const PhaseTime> times() const noexcept { return times_; }

private:
    using Clock = std::chrono::steady_clock;

    std::vector<PhaseTime> times_;
    Clock::time_point last_ = Clock::now();
};

}  // namespace hashphase::demos
