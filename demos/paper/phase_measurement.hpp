// SPDX-License-Identifier: Zlib
#pragma once

// Times the methods of a phase against each other, frame by frame in turn, and compares what they
// found with brute force.
//
// Frames    The first one is not counted, but for methods that take a quarter of a second for it,
//           and keep nothing from frame to frame, as hashphase does. Each method runs for the first
//           frames, as many as it may take time for, and at least a few: what is slow has fewer,
//           and says how many.
// Checked   In every frame that the un-optimized method runs; without it in the first one and the
//           last that all methods run, where there are many objects for some drawn at random.

#include <demos/paper/phase_method.hpp>
#include <demos/report/check.hpp>
#include <demos/report/statistics.hpp>

#include <functional>
#include <string>

namespace hashphase::demos {

struct PhaseEffort {
    std::uint32_t frames = 60;        // of a method, at most
    std::uint32_t fewestFrames = 3;   // at least 1
    double methodMilliseconds = 400;  // that a method may take for more frames than the fewest
};

using IsTimeUp = std::function<bool()>;

/// What is to be measured.
struct PhaseTask {
    Phase phase = Phase::collision;
    std::uint32_t objects = 0;
    std::uint64_t seed = 1;
    float aiRadius = 10;  // [m]
};

/// Of more objects than kMostBruteForced, so many are compared with all.
inline constexpr std::uint32_t kSubjectsBeyond = 1'000;

struct MethodResult {
    MethodKind kind = MethodKind::hashphase;
    std::optional<double> cellSize;  // [m]
    std::vector<double> frameMs;     // empty: the time was up before
    std::vector<double> hashMs;      // of these, what PhaseMethod::hash() took
    std::uint32_t checkedFrames = 0;
    std::uint32_t wrongFrames = 0;
    std::string fault;  // of the first of these: "3 of 5,000 are missing, 0 are extra"
    std::size_t bytes = 0;

    [[nodiscard]] bool isMeasured() const { return !frameMs.empty(); }
    /// The frames less their hashing [ms].
    [[nodiscard]] std::vector<double> lookMs() const;
    /// [ms]; only of what is measured.
    [[nodiscard]] Spread time() const { return spreadOf(frameMs); }
    /// [frames/s], of the median; nothing where nothing is measured.
    [[nodiscard]] std::optional<double> rate() const;
};

struct PhaseResult {
    PhaseTask task;
    std::vector<MethodResult> methods;  // in the order of their specs
    std::uint32_t subjects = 0;         // for how many objects a checked frame was checked
    std::size_t found = 0;  // in the first frame, with or by subjects: PhaseAnswer::found

    [[nodiscard]] const MethodResult* find(MethodKind kind, std::optional<double> cellSize) const;
};

/// "paper's grid, cells of 25 m".
[[nodiscard]] std::string describe(const MethodResult& method);

/// Where the time is up, what has not run is left out.
[[nodiscard]] PhaseResult measurePhase(
    const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
    const IsTimeUp& isTimeUp = [] { return false; });

/// What is wrong with an answer for all objects, given the right one for the subjects; empty where
/// nothing is.
[[nodiscard]] std::string faultOf(Phase phase, const PhaseAnswer& answer, const PhaseAnswer& right,
                                  const Subjects& subjects);

/// That of all results no frame is wrong, with the first that are.
[[nodiscard]] Check agreement(std::span<const PhaseResult> results);

}  // namespace hashphase::demos
