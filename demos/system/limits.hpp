// SPDX-License-Identifier: Zlib
#pragma once

// Clocks and limits of a process, where the system has them (limits_posix.cpp). Elsewhere (limits_none.cpp)
// nothing is limited.

#include <cstdint>

namespace hashphase::demos {

/// While it lives, time does not count: for the truth that answers are compared with. Within
/// runIsolated()'s work, not nested; elsewhere it does nothing.
class LimitPause {
public:
    LimitPause();
    LimitPause(const LimitPause&) = delete;
    LimitPause& operator=(const LimitPause&) = delete;
    ~LimitPause();

private:
    std::int64_t left_ = 0;  // [us]
};

/// While it lives, the process gets no more than so many bytes of memory beyond what it has.
class MemoryLimit {
public:
    /// Whether it limits anything. (Sanitizers end a program that runs out of memory, and emulators of other
    /// processors have no such limit.)
    [[nodiscard]] static bool isPossible() noexcept;

    explicit MemoryLimit(std::uint64_t more);
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
    ~MemoryLimit();

private:
    std::uint64_t before_ = 0;
};

/// The processor time of the calling thread since some moment [ms], or wall time where the system has no such
/// clock, or one of 15 ms, as Windows has.
[[nodiscard]] double threadMilliseconds() noexcept;

}  // namespace hashphase::demos
