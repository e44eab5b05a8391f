// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/system/interruption.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

namespace hashphase::demos {

/// The time that a command may take, from its creation on: a number of seconds, or as long as it takes. It is over,
/// too, once the process is asked to end.
class TimeLimit {
public:
    explicit TimeLimit(std::optional<double> seconds)
        : seconds_(seconds.value_or(std::numeric_limits<double>::infinity())) {}

    /// Not below 0; infinite without a limit.
    [[nodiscard]] double secondsLeft() const {
        return isInterrupted() ? 0 : std::max(seconds_ - watch_.milliseconds() / 1000, 0.0);
    }
    [[nodiscard]] bool isOver() const { return secondsLeft() <= 0; }

    /// Why it is over, to begin a sentence with: "The time limit of 5 s was reached".
    [[nodiscard]] std::string reason() const {
        return isInterrupted() ? "The run was interrupted"
                               : "The time limit of " + plain(seconds_) + " s was reached";
    }

private:
    double seconds_;
    Stopwatch watch_;
};

}  // namespace hashphase::demos
