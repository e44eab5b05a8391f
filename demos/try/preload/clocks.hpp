// SPDX-License-Identifier: Zlib
#pragma once

// The two clocks by which steps are timed, and what it costs to look at them: some 20 ns for the one on
// the wall; some 400 ns for that of a thread, and for that of all threads, which are system calls.

#include <cstdint>

namespace hashphase::tryout {

/// A moment of the calling thread, or how long something took, by both clocks [ns].
struct ClockTimes {
    std::int64_t wall = 0;
    std::int64_t processor = 0;

    ClockTimes& operator+=(const ClockTimes& other) noexcept {
        wall += other.wall;
        processor += other.processor;
        return *this;
    }
    friend ClockTimes operator-(const ClockTimes& a, const ClockTimes& b) noexcept {
        return {a.wall - b.wall, a.processor - b.processor};
    }
};

[[nodiscard]] std::int64_t wallNanoseconds() noexcept;

/// The time that all threads of this process have had a processor.
[[nodiscard]] std::int64_t allProcessorNanoseconds() noexcept;

/// Now: for the begin and the end of what is timed, whose time on the wall holds no look at the other
/// clock. That one is not looked at again within a microsecond, in which nothing else can have run.
[[nodiscard]] ClockTimes beginMoment() noexcept;
[[nodiscard]] ClockTimes endMoment() noexcept;

/// What these looks have taken this thread so far: to be taken from what they were made in the midst of.
[[nodiscard]] std::int64_t nanosecondsOfLooks() noexcept;

}  // namespace hashphase::tryout
