// SPDX-License-Identifier: Zlib
#include <demos/accuracy/experiment.hpp>

#include <demos/report/frame_clock.hpp>

namespace hashphase::demos {

std::span<const Experiment> experiments() {
    static const std::vector<Experiment> all{
        sweepExperiment(),   cellSizeExperiment(), proximityExperiment(), cullingExperiment(),
        pickingExperiment(), originExperiment(),   timeStepExperiment(),  trajectoryExperiment(),
        terrainExperiment(), updateExperiment(),
    };
    return all;
}

void measureTimes(Measurements& measured, const TimedFrames& timed,
                  const std::function<void(int frame)>& begin,
                  std::span<const TimedMethod> methods) {
    std::vector<std::vector<double>> times(methods.size());
    for (int frame = 0; frame < timed.warmUp + timed.frames; ++frame) {
        begin(frame);
        for (std::size_t turn = 0; turn < methods.size(); ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(frame)) % methods.size();
            const FrameClock clock;
            methods[i].run();
            const double elapsed = clock.milliseconds();
            if (frame >= timed.warmUp) {
                times[i].push_back(elapsed);
            }
        }
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
        for (const double milliseconds : times[i]) {
            Record row = methods[i].columns;
            row.emplace_back("ms", milliseconds * timed.scale);
            measured.add(timed.table, row);
        }
    }
}

}  // namespace hashphase::demos
