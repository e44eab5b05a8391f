// SPDX-License-Identifier: Zlib
#include <demos/accuracy/timing.hpp>

#include <demos/report/frame_clock.hpp>

#if defined(__linux__)
#include <sched.h>
#endif

namespace hashphase::demos {

std::vector<std::vector<double>> timesInTurn(int frames, int warmUp,
                                             const std::function<void(int frame)>& begin,
                                             std::span<const std::function<void()>> methods) {
    std::vector<std::vector<double>> times(methods.size());
    for (int frame = 0; frame < warmUp + frames; ++frame) {
        begin(frame);
        for (std::size_t turn = 0; turn < methods.size(); ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(frame)) % methods.size();
            const FrameClock clock;
            methods[i]();
            const double elapsed = clock.milliseconds();
            if (frame >= warmUp) {
                times[i].push_back(elapsed);
            }
        }
    }
    return times;
}

void measureTimes(Measurements& measured, int frames, int warmUp,
                  const std::function<void(int frame)>& begin, std::span<const TimedMethod> methods,
                  double scale) {
    std::vector<std::function<void()>> runs;
    for (const TimedMethod& method : methods) {
        runs.push_back(method.run);
    }
    const auto times = timesInTurn(frames, warmUp, begin, runs);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        for (const double milliseconds : times[i]) {
            Record row = methods[i].columns;
            row.emplace_back("ms", milliseconds * scale);
            measured.add("times", row);
        }
    }
}

void pinToThisCore() {
#if defined(__linux__)
    const int core = sched_getcpu();
    if (core >= 0) {
        cpu_set_t cores;
        CPU_ZERO(&cores);
        CPU_SET(static_cast<unsigned>(core), &cores);
        // Refused in some containers; the times are then a little less steady.
        static_cast<void>(sched_setaffinity(0, sizeof(cores), &cores));
    }
#endif
}

}  // namespace hashphase::demos
