// SPDX-License-Identifier: Zlib
#include <demos/system/other_programs.hpp>

#include <chrono>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

double secondsOf(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double secondsUsed(int who) {
    rusage used{};
    static_cast<void>(getrusage(who, &used));
    return secondsOf(used.ru_utime) + secondsOf(used.ru_stime);
}

}  // namespace

std::optional<ProcessorTimes> processorTimes() {
    std::ifstream stat("/proc/stat");
    const std::optional<double> ticks = busyTicks(stat);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now().time_since_epoch();
    return ticks ? std::optional(ProcessorTimes{
                       wall.count(), *ticks / static_cast<double>(sysconf(_SC_CLK_TCK)),
                       secondsUsed(RUSAGE_SELF) + secondsUsed(RUSAGE_CHILDREN)})
                 : std::nullopt;
}

}  // namespace hashphase::demos
