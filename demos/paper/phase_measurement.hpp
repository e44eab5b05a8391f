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
// Rows      `runs`, one for each method; `frames`, what each timed frame took; `checks`, each frame that
//           was compared, with its fault; `memory`, of what was timed. See paper.sql.

#include <demos/experiment/measurements.hpp>
#include <demos/paper/phase_method.hpp>

#include <functional>
#include <span>
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
    float aiRadius = 10;               // [m]
    std::string_view part = "figure";  // that it is measured for
};

/// At most so many objects are compared with all where the un-optimized method has not run, in a last
/// frame or where there are more than kMostBruteForced.
inline constexpr std::uint32_t kSpotChecked = 1'000;

/// Where the time is up, what has not run is left out.
void measurePhase(
    const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
    Measurements& measured, const IsTimeUp& isTimeUp = [] { return false; });

/// How well spheres, AABBs and OBBs work as a first pass for sticks, which are not round (the paper's
/// "efficiency of hashing different bounding volume types"): a row of `volumes` for each in turn in each
/// frame, as many as the effort allows until the time is up. In the first frame, which is not timed, they
/// are compared with the exact test of all pairs: a row of `volume_checks` for each.
void measureVolumes(
    std::uint32_t sticks, const PhaseEffort& effort, std::uint64_t seed, Measurements& measured,
    const IsTimeUp& isTimeUp = [] { return false; });

/// What is wrong with an answer for all objects, given the right one for the subjects; nothing where
/// nothing is: "3 of 5,000 are missing, 0 are extra".
[[nodiscard]] std::optional<std::string> faultOf(Phase phase, const PhaseAnswer& answer,
                                                 const PhaseAnswer& right,
                                                 const Subjects& subjects);

}  // namespace hashphase::demos
