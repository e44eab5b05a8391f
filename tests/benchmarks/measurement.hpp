// SPDX-License-Identifier: Zlib
#pragma once

// Runs one case: a benchmark at one size, all its contestants interleaved frame by frame, every
// answer checked.

#include <demos/report/statistics.hpp>
#include <tests/benchmarks/catalog.hpp>

#include <algorithm>
#include <functional>
#include <optional>
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

/// How a contestant's answers compared with the exact ones, over all checked frames.
struct AnswerTally {
    int framesChecked = 0;
    std::uint64_t answers = 0;     // with duplicates
    std::uint64_t exact = 0;       // what there was to find
    std::uint64_t missing = 0;     // of these, not reported
    std::uint64_t extra = 0;       // reported, but not so: a superset
    std::uint64_t duplicates = 0;  // reported again in the same frame

    [[nodiscard]] bool isExact() const noexcept { return missing + extra + duplicates == 0; }
};

/// Adds one frame to the tally. `answers` may come in any order and is sorted; `exact` is sorted.
/// Returns the first wrong answer in a sentence, empty when there is none.
std::string auditAnswers(std::vector<Answer>& answers, const std::vector<Answer>& exact,
                         AnswerTally& tally);

struct ContestantResult {
    ContestantKind kind;
    double fillMs = 0;            // making and filling it
    std::vector<double> frameMs;  // by measured frame
    bool droppedOut = false;      // too slow, see Benchmark::dropFactor
    AnswerTally tally;
    std::string firstFault;  // empty when all was exact
    Memory memory;

    [[nodiscard]] std::optional<demos::Spread> spread() const;
};

struct CaseResult {
    std::string name;
    std::string group;
    std::string description;
    std::string operation;
    std::size_t objects = 0;
    std::size_t operations = 0;  // a frame
    int warmUpFrames = 0;
    int framesDone = 0;  // measured
    bool timeLimitHit = false;
    std::vector<ContestantResult> contestants;

    [[nodiscard]] const ContestantResult* find(std::string_view contestant) const;

    /// True when no checked answer of ours was wrong.
    [[nodiscard]] bool oursWereExact() const;
};

/// The median over all frames of how many times longer `other` took than `own` in the same frame.
/// Nothing where either was not measured.
[[nodiscard]] std::optional<double> speedAgainst(const ContestantResult* other,
                                                 const ContestantResult& own);

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

[[nodiscard]] CaseResult measure(const Case& toRun, const MeasurementSettings& settings);

}  // namespace hashphase::benchmarks
