// SPDX-License-Identifier: Zlib
#include <demos/try/preload/clocks.hpp>

#include <algorithm>
#include <chrono>
#include <optional>

#include <time.h>

namespace hashphase::tryout {
namespace {

// The last look of this thread at its own clock, and what all have taken.
thread_local Moment last;
thread_local std::int64_t lookTime = 0;

// Where there is no such clock, the one on the wall stands in for it.
std::int64_t processorNanoseconds(clockid_t clock) noexcept {
    timespec time{};
    if (clock_gettime(clock, &time) != 0) {
        return wallNanoseconds();
    }
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::optional<Moment> momentByLastLook(std::int64_t wall) noexcept {
    constexpr std::int64_t kFresh = 1000;
    const std::int64_t since = wall - last.wall;
    if (since <= 0 || since >= kFresh) {  // 0: a program may have made the clock stand still
        return std::nullopt;
    }
    return Moment{wall, last.processor + since};
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

Moment beginMoment() noexcept {
    const std::int64_t wall = wallNanoseconds();
    if (const std::optional<Moment> moment = momentByLastLook(wall)) {
        return *moment;
    }
    last.processor = lookAtProcessor(wall);
    last.wall = wallNanoseconds();
    return last;
}

Moment endMoment() noexcept {
    const std::int64_t wall = wallNanoseconds();
    if (const std::optional<Moment> moment = momentByLastLook(wall)) {
        return *moment;
    }
    last = {wall, lookAtProcessor(wall)};
    return last;
}

std::int64_t nanosecondsOfLooks() noexcept {
    return lookTime;
}

}  // namespace hashphase::tryout
