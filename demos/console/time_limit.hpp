// SPDX-License-Identifier: Zlib
#pragma once

// The time that a command may take, from the creation of its TimeLimit on.

#include <demos/report/stopwatch.hpp>

#include <limits>
#include <optional>

namespace hashphase::demos {

class TimeLimit {
public:
    /// In seconds; nothing: as long as it takes.
    explicit TimeLimit(std::optional<double> seconds) : seconds_(seconds) {}

    /// Seconds until it is over; not below 0, and infinite without a limit.
    [[nodiscard]] double secondsLeft() const {
        const double left = seconds_.value_or(std::numeric_limits<double>::infinity()) -
                            watch_.milliseconds() / 1000;
        return left > 0 ? left : 0;
    }
    [[nodiscard]] bool isOver() const { return secondsLeft() <= 0; }

private:
    std::optional<double> seconds_;
    Stopwatch watch_;
};

}  // namespace hashphase::demos
