// SPDX-License-Identifier: Zlib
#pragma once

// Times methods against each other so that their ratios can be trusted.

#include <demos/experiment/measurements.hpp>

#include <functional>
#include <span>
#include <vector>

namespace hashphase::demos {

/// Fewer different frames than this are no measurement.
inline constexpr int kFewestFrames = 60;

/// Runs begin(frame) and then all methods, in an order that rotates, for each of `frames` frames
/// after `warmUp` more that are not timed. Returns the times of all frames, method by method [ms],
/// less what other programs took of the processor meanwhile; on this thread only.
[[nodiscard]] std::vector<std::vector<double>> timesInTurn(
    int frames, int warmUp, const std::function<void(int frame)>& begin,
    std::span<const std::function<void()>> methods);

/// A method to be timed, and the columns that name it.
struct TimedMethod {
    Record columns;
    std::function<void()> run;
};

/// The same, but adds each time to the table "times": a row with the method's columns, and then
/// "ms", multiplied by `scale`.
void measureTimes(Measurements& measured, int frames, int warmUp,
                  const std::function<void(int frame)>& begin, std::span<const TimedMethod> methods,
                  double scale = 1);

/// Keeps the calling thread on the core where it is: the scheduler moves threads, and caches do not
/// move along. Does nothing where the system has no such call.
void pinToThisCore();

}  // namespace hashphase::demos
