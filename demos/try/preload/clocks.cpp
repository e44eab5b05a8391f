// SPDX-License-Identifier: Zlib
#include <demos/try/preload/clocks.hpp>

#include <algorithm>
#include <chrono>

#include <time.h>

namespace hashphase::tryout {
namespace {

// The last look of this thread at its own clock, and what all have taken.
thread_local ClockTimes last;
thread_local std::int64_t lookTime = 0;

// Where there is no such clock, the one on the wall stands in for it.
std::int64_t processorNanoseconds(clockid_t clock) noexcept {
    timespec time{};
    if (clock_gettime(clock, &time) != 0) {
        return wallNanoseconds();
    }
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// 0: a program may have made the clock stand still.
bool isFresh(std::int64_t wall) noexcept {
    constexpr std::int64_t kFresh = 1000;
    return wall - last.wall > 0 && wall - last.wall < kFresh;
}

ClockTimes byLastLook(std::int64_t wall) noexcept {
    return {wall, last.processor + (wall - last.wall)};
}

// Others that run meanwhile do not count: as much as they take, no look does.
std::int64_t lookAtProcessor(std::int64_t begin) noexcept {
    constexpr std::int64_t kMost = 2000;
    const std::int64_t processor = processorNanoseconds(CLOCK_THREAD_CPUTIME_ID);
    lookTime += std::clamp(wallNanoseconds() - begin, std::int64_t{0}, kMost);
    return processor;
}

}  // namespace

std::int64_t wallNanoseconds() noexcept {
    return std::chrono::steady_clock::now().time_since_epoch().count();
}

std::int64_t allProcessorNanoseconds() noexcept {
    return processorNanoseconds(CLOCK_PROCESS_CPUTIME_ID);
}

ClockTimes beginMoment() noexcept {
    const std::int64_t wall = wallNanoseconds();
    if (!isFresh(wall)) {
        last.processor = lookAtProcessor(wall);
        last.wall = wallNanoseconds();
        return last;
    }
    return byLastLook(wall);
}

ClockTimes endMoment() noexcept {
    const std::int64_t wall = wallNanoseconds();
    if (!isFresh(wall)) {
        last = {wall, lookAtProcessor(wall)};
    }
    return byLastLook(wall);
}

std::int64_t nanosecondsOfLooks() noexcept {
    return lookTime;
}

}  // namespace hashphase::tryout
