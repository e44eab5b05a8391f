// SPDX-License-Identifier: Zlib
#include <demos/system/limits.hpp>

#include <fstream>

#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
#if HASHPHASE_HAS_MALLOC_TRIM
#include <malloc.h>
#endif

namespace hashphase::demos {
namespace {

constexpr std::int64_t kMicroseconds = 1'000'000;

#if HASHPHASE_IS_SANITIZED
constexpr bool kCanRunOutOfMemory = false;
#else
constexpr bool kCanRunOutOfMemory = true;
#endif

}  // namespace

LimitPause::LimitPause() {
    const itimerval off{};
    itimerval left{};
    setitimer(ITIMER_PROF, &off, &left);
    left_ = left.it_value.tv_sec * kMicroseconds + left.it_value.tv_usec;
}

LimitPause::~LimitPause() {
    if (left_ != 0) {
        itimerval left{};
        left.it_value.tv_sec = static_cast<time_t>(left_ / kMicroseconds);
        left.it_value.tv_usec = static_cast<suseconds_t>(left_ % kMicroseconds);
        setitimer(ITIMER_PROF, &left, nullptr);
    }
}

bool MemoryLimit::isPossible() noexcept {
    if (!kCanRunOutOfMemory) {
        return false;
    }
    // Emulators take no notice of it.
    const MemoryLimit limit(std::uint64_t{1} << 30);
    rlimit now{};
    return getrlimit(RLIMIT_AS, &now) == 0 && now.rlim_cur != limit.before_;
}

MemoryLimit::MemoryLimit(std::uint64_t more) {
#if HASHPHASE_HAS_MALLOC_TRIM
    malloc_trim(0);
#endif
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    before_ = limit.rlim_cur;
    limit.rlim_cur = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + more;
    setrlimit(RLIMIT_AS, &limit);
}

MemoryLimit::~MemoryLimit() {
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = before_;
    setrlimit(RLIMIT_AS, &limit);
}

double threadMilliseconds() noexcept {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace hashphase::demos
