// SPDX-License-Identifier: Zlib
#pragma once

// Times the methods of a phase against each other, frame by frame, and compares what they found with
// brute force.
//
// Frames    The first one is not counted, but for methods that take a quarter of a second for it,
//           and keep nothing from frame to frame, as hashphase does. Each method runs for the first
//           frames, as many as it may take time for, and at least a few: what is slow has fewer,
//           and says how many.
// Turns     In each frame all methods have a turn, in an order that is drawn anew; hurried, in the
//           order of their specs, for the time may be up in the first frame.
// Checked   In every frame that the un-optimized method runs, for all objects. Without it in the
//           first frame, unless hurried, and in the last one of each method for some objects drawn at
//           random.

#include <demos/paper/paper_check.hpp>
#include <demos/paper/phase_method.hpp>
#include <demos/report/statistics.hpp>

#include <functional>
#include <string>

namespace hashphase::demos {

struct PhaseEffort {
    std::uint32_t frames = 60;        // of a method, at most
    std::uint32_t fewestFrames = 3;   // at least 1
    double methodMilliseconds = 400;  // that a method may take for more frames than the fewest
    double slowMilliseconds =
        250;                 // of a frame, from which on it matters little that memory was new
    bool isHurried = false;  // the time may be up before everything is measured
};

using IsTimeUp = std::function<bool()>;

/// What is to be measured.
struct PhaseTask {
    Phase phase = Phase::collision;
    std::uint32_t objects = 0;
    std::uint64_t seed = 1;
    float aiRadius = 10;  // [m]
};

/// At most so many objects are compared with all where the un-optimized method has not run, in a last
/// frame or where there are more than kMostBruteForced.
inline constexpr std::uint32_t kSpotChecked = 1'000;

struct MethodResult {
    MethodKind kind = MethodKind::hashphase;
    std::optional<double> cellSize;  // [m]
    std::vector<double> frameMs;     // empty: the time was up before
    std::vector<double> hashMs;      // of these, what PhaseMethod::hash() took
    std::vector<double> standMs;     // ... and PhaseMethod::stand()
    std::uint32_t checkedFrames = 0;
    std::uint32_t checkedTimed = 0;    // of these, which were timed too
    std::uint64_t checkedObjects = 0;  // of all these frames
    std::uint32_t wrongFrames = 0;
    std::string fault;  // of the first of these: "3 of 5,000 are missing, 0 are extra"
    std::optional<std::size_t> bytes;      // of what is measured
    std::optional<double> chosenCellSize;  // [m]; of what is measured and has cells

    [[nodiscard]] bool isMeasured() const { return !frameMs.empty(); }
    /// The frames less their hashing and the ground [ms].
    [[nodiscard]] std::vector<double> lookMs() const;
    /// [ms]; only of what is measured.
    [[nodiscard]] Spread time() const { return spreadOf(frameMs); }
    /// [frames/s], of the median; nothing where nothing is measured.
    [[nodiscard]] std::optional<double> rate() const;
};

struct PhaseResult {
    PhaseTask task;
    float side = 0;                     // of the domain [m]
    std::size_t triangles = 0;          // of the ground
    std::vector<MethodResult> methods;  // in the order of their specs
    std::size_t found = 0;  // most that a check has found right in a frame: PhaseAnswer::found

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

/// That of all results no frame is wrong, with the first that are; not checked where no frame was.
[[nodiscard]] PaperCheck agreement(std::span<const PhaseResult> results);

}  // namespace hashphase::demos
