// SPDX-License-Identifier: Zlib
#include <demos/accuracy/experiment.hpp>

#include <demos/report/frame_clock.hpp>
#include <demos/scenes/random.hpp>
#include <demos/system/interruption.hpp>

#include <numeric>
#include <utility>

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
    std::vector<std::size_t> order(methods.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random random(0x5eed0d01);
    for (int frame = 0; frame < timed.warmUp + timed.frames; ++frame) {
        throwIfInterrupted();
        begin(frame);
        shuffle(order, random);
        for (const std::size_t i : order) {
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
