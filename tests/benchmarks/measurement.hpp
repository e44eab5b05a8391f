// SPDX-License-Identifier: Zlib
#pragma once

// Runs one case: a benchmark at one size, all its contestants interleaved frame by frame, every
// answer checked; and writes down what was measured as rows, of which case.sql and summary.sql make the tables.
//
// Why a runner of our own: the contestants take turns within each frame, frames differ, and what counts is
// the ratio of both times in the same frame. Google Benchmark and nanobench run one function again and
// again, one contestant after the other; what the machine does meanwhile goes into the ratio.

#include <demos/experiment/measurements.hpp>
#include <tests/benchmarks/workload.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace hashphase::benchmarks {

/// A benchmark at one size, with those that take part.
struct Case {
    const Benchmark* benchmark = nullptr;
    std::size_t objects = 0;
    std::vector<ContestantKind> contestants;

    [[nodiscard]] std::string name() const {
        return benchmark->name + "/" + std::to_string(objects);
    }
};

/// How a contestant's answers in a frame compared with the exact ones.
struct FrameAudit {
    std::size_t answers = 0;     // with duplicates
    std::size_t missing = 0;     // of the exact ones, not reported
    std::size_t extra = 0;       // reported, but not so: a superset
    std::size_t duplicates = 0;  // reported again
    std::string fault;           // the first wrong answer in a sentence; empty when there is none
};

/// `answers` may come in any order and is sorted; `exact` is sorted.
[[nodiscard]] FrameAudit auditAnswers(std::vector<Answer>& answers,
                                      const std::vector<Answer>& exact);

struct MeasurementSettings {
    // Frames of so few objects are short and soon disturbed: more of them are measured.
    static constexpr std::size_t kSmall = 1'000;
    static constexpr int kFramesOfSmall = 300;

    int frames = 60;        // measured, of what is not small
    int warmUpFrames = 10;  // checked, but not timed
    std::uint64_t seed = 1;
    std::function<bool()> isTimeUp = [] { return false; };  // asked before each frame
    std::function<void(int framesDone)> tellProgress = [](int) {};

    /// As many as a case has of itself.
    [[nodiscard]] int framesOf(std::size_t objects) const {
        return objects <= kSmall ? std::max(frames, kFramesOfSmall) : frames;
    }
};

/// Adds the rows of the case, and returns its number.
std::int64_t measure(const Case& toRun, const MeasurementSettings& settings,
                     demos::Measurements& measured);

}  // namespace hashphase::benchmarks
