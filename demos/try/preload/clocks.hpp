// SPDX-License-Identifier: Zlib
#pragma once

// The two clocks by which steps are timed, and what it costs to look at them: some 20 ns for the one on
// the wall; some 400 ns for that of a thread, and for that of all threads, which are system calls.

#include <cstdint>

namespace hashphase::tryout {

/// Of the calling thread [ns].
struct Moment {
    std::int64_t wall = 0;
    std::int64_t processor = 0;
};

[[nodiscard]] std::int64_t wallNanoseconds() noexcept;

/// The time that all threads of this process have had a processor.
[[nodiscard]] std::int64_t allProcessorNanoseconds() noexcept;

/// Now: for the begin and the end of what is timed, whose time on the wall holds no look at the other
/// clock. That one is not looked at again within a microsecond, in which nothing else can have run.
[[nodiscard]] Moment beginMoment() noexcept;
[[nodiscard]] Moment endMoment() noexcept;

/// What these looks have taken this thread so far: to be taken from what they were made in the midst of.
[[nodiscard]] std::int64_t nanosecondsOfLooks() noexcept;

}  // namespace hashphase::tryout
