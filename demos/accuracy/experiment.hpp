// SPDX-License-Identifier: Zlib
#pragma once

// An experiment about what accuracy costs in time: a question, the methods that answer it, the error
// and the time of each.
//
// Truth     comes from brute force, in rational or much higher precision where rounding matters;
//           never from a method under test.
// Missed    and false answers are different columns: the former are wrong, the latter cost time.
// Times     are medians of at least 60 different frames, methods in random order within each.

#include <demos/experiment/findings.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// How much an experiment may measure.
struct Effort {
    bool isQuick = false;
    std::uint64_t seed = 1;

    /// One or the other.
    template <class Number>
    [[nodiscard]] Number quickOrFull(Number quick, Number full) const {
        return isQuick ? quick : full;
    }
};

/// Takes the share that is done, 0 to 1, and what is being done. Throws Interrupted.
using TellProgress = std::function<void(double, std::string_view)>;

struct Experiment {
    std::string_view id;  // "P1"
    std::string_view title;
    std::string_view question;
    double quickSeconds;  // about how long it takes, for the progress bar
    double fullSeconds;
    std::function<Findings(const Effort&, const TellProgress&)> run;
};

// Each in a folder.
[[nodiscard]] Experiment sweepExperiment();       // P1
[[nodiscard]] Experiment cellSizeExperiment();    // P2
[[nodiscard]] Experiment proximityExperiment();   // P3
[[nodiscard]] Experiment cullingExperiment();     // P4
[[nodiscard]] Experiment pickingExperiment();     // P5
[[nodiscard]] Experiment originExperiment();      // P6
[[nodiscard]] Experiment timeStepExperiment();    // P7
[[nodiscard]] Experiment trajectoryExperiment();  // P8
[[nodiscard]] Experiment terrainExperiment();     // P9
[[nodiscard]] Experiment updateExperiment();      // P10

/// All of them, in that order.
[[nodiscard]] std::span<const Experiment> experiments();

// --- Methods ---------------------------------------------------------------------------------------

/// A way to do what an experiment is about.
template <class Make>
struct Method {
    std::string name;
    std::string
        traits;  // whose it is ("ours", "paper", "bullet", "others"), then words of the experiment
    std::function<Make> make;

    [[nodiscard]] std::string origin() const { return traits.substr(0, traits.find(' ')); }
    [[nodiscard]] bool is(std::string_view trait) const {
        return (' ' + traits + ' ').find(' ' + std::string(trait) + ' ') != std::string::npos;
    }
};

/// Adds a row to the table "methods" for each: its number, its name, whose it is, and of each trait
/// whether it has it.
template <class Make>
void addMethods(std::span<const Method<Make>> methods,
                std::initializer_list<std::string_view> traits, Measurements& measured) {
    for (const Method<Make>& method : methods) {
        Record row{{"number", &method - methods.data()},
                   {"method", method.name},
                   {"origin", method.origin()},
                   {"ours", method.is("ours")}};
        for (const std::string_view trait : traits) {
            row.emplace_back(trait, method.is(trait));
        }
        measured.add("methods", row);
    }
}

// --- Times -----------------------------------------------------------------------------------------

/// Fewer different frames than this are no measurement.
inline constexpr int kFewestFrames = 60;

/// Frames that are timed, after some more that are not.
struct TimedFrames {
    int frames = kFewestFrames;
    int warmUp = 0;
    double scale = 1;                  // of what is noted to a frame
    std::string_view table = "times";  // in which
};

/// A method to be timed, and the columns that name it.
struct TimedMethod {
    Record columns;
    std::function<void()> run;
};

/// Times methods against each other so that their ratios can be trusted: runs begin(frame) and then all
/// of them for each of the frames, in an order that is drawn for each frame, and is the same in each run.
/// In a fixed order, a method always finds in the processor's caches what the same other one has left
/// there. Adds the time of each, less what other programs took of the processor meanwhile, on this thread
/// only: a row with the method's columns, and then "ms".
/// Throws Interrupted.
void measureTimes(Measurements& measured, const TimedFrames& timed,
                  const std::function<void(int frame)>& begin,
                  std::span<const TimedMethod> methods);

}  // namespace hashphase::demos
