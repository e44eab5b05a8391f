// SPDX-License-Identifier: Zlib
#pragma once

// How much of the processor other programs use while this one measures. The load average does not tell: it counts this
// program, too, and what ended a minute before.

#include <functional>
#include <iosfwd>
#include <optional>

namespace hashphase::demos {

/// Times since some moments in the past [s].
struct ProcessorTimes {
    double wall = 0;
    double all = 0;  // of all programs and the system, on all cores
    double own = 0;  // of this process, all threads, and its children that it has waited for
};

/// Now; nothing if the system does not tell.
[[nodiscard]] std::optional<ProcessorTimes> processorTimes();

/// How long all cores together have worked [ticks], as the first line of Linux's /proc/stat says; nothing if it does
/// not.
[[nodiscard]] std::optional<double> busyTicks(std::istream& stat);

/// Constructed when measuring begins, asked when it ends.
class OtherPrograms {
public:
    using Read = std::function<std::optional<ProcessorTimes>()>;

    explicit OtherPrograms(Read read = processorTimes);

    /// How many cores they used since construction, on average; nothing if the system does not tell, or for less than
    /// half a second: it counts in ticks of 10 ms.
    [[nodiscard]] std::optional<double> cores() const;

private:
    Read read_;
    std::optional<ProcessorTimes> begin_;
};

}  // namespace hashphase::demos
