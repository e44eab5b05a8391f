// SPDX-License-Identifier: Zlib
#pragma once

// A program that is tried, and its runs: each with a library preloaded, and a record that it fills.

#include <demos/report/provenance.hpp>
#include <demos/try/program_file.hpp>
#include <demos/try/record.hpp>
#include <demos/try/running_program.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct TriedRunSettings {
    std::string path;                   // of the program
    std::vector<std::string> words;     // argv, the name first
    std::vector<std::string> preloads;  // paths of libraries, the first one first
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    std::optional<std::uint32_t> stepLimit;  // ends the program after so many steps
    std::optional<double> secondLimit;       // or seconds
    std::int64_t inputBegin = -1;            // where its input begins; negative: in no file
    std::function<void()> sayThatItWaits;    // for what was left behind, and has no broadphase
};

/// How a program ended.
struct RunEnd {
    bool isCrash = false;    // by a signal that nobody here has sent
    bool isHidden = false;   // a crash, of which who started the recorded process has not told
    bool isStopped = false;  // by us, at a limit or because we were interrupted
    int code = 0;  // its exit status, or the signal; of a hidden crash, the status without it
};

/// Whether one is as good as the other: at a limit who was stopped may have been about to end.
[[nodiscard]] bool areAlike(const RunEnd& a, const RunEnd& b) noexcept;

/// "ended with status 0", "was ended by signal 11 (Segmentation fault)".
[[nodiscard]] std::string textOf(const RunEnd& end);

struct TriedRun {
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    RunEnd end;
    bool isLoaded = false;  // the library, into whatever ran
    bool hasBroadphase = false;
    std::uint32_t dbvtCount = 0;
    std::uint32_t axisSweepCount = 0;
    std::uint32_t derivedSweepCount = 0;
    std::uint32_t foreignCalculations = 0;
    std::uint32_t otherProcesses = 0;
    std::uint32_t droppedRows = 0;
    std::vector<tryout::StepRow> rows;  // steps; of a program that makes none, calculations
    tryout::Verification verification;  // of Broadphase::verifying
};

/// What was tried, and all runs of it, by turns: Bullet's, ours, Bullet's, ours; or a verified one.
struct Trial {
    std::string commandLine;
    TriedProgram program;
    std::vector<TriedRun> runs;
    Provenance provenance;  // after them: how busy the machine was
};

/// Runs the program to its end, or to a limit, with this process's streams, of which the input begins where it
/// is told. What `signals` notes ends it, too: at first it is asked to, some seconds later no longer. Throws
/// InputError when it cannot be started.
[[nodiscard]] TriedRun runTried(const TriedRunSettings& settings, const NotedSignals& signals);

}  // namespace hashphase::demos
