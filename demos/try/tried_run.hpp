// SPDX-License-Identifier: Zlib
#pragma once

// One run of a program that is tried: with a library preloaded, and a record that it fills.

#include <demos/try/record.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct TriedRunSettings {
    std::string path;                // of the program
    std::vector<std::string> words;  // argv, the name first
    std::string preload;             // path of the library
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    std::optional<std::uint32_t> stepLimit;  // ends the program after so many steps
    std::optional<double> secondLimit;       // or seconds
};

/// How a program ended.
struct RunEnd {
    bool isCrash = false;    // by a signal that nobody here has sent
    bool isStopped = false;  // by us, at a limit
    int code = 0;            // its exit status, or the signal

    bool operator==(const RunEnd&) const = default;
};

/// "ended with status 0", "was ended by signal 11 (Segmentation fault)".
[[nodiscard]] std::string textOf(const RunEnd& end);

struct TriedRun {
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    RunEnd end;
    bool hasBroadphase = false;
    std::uint32_t dbvtCount = 0;
    std::uint32_t axisSweepCount = 0;
    std::uint32_t foreignCalculations = 0;
    std::uint32_t otherProcesses = 0;
    std::vector<tryout::StepRow> rows;

    // Of Broadphase::verifying.
    std::uint64_t calculations = 0;
    std::uint64_t pairs = 0;
    std::uint64_t missing = 0;
    std::uint64_t extra = 0;
    std::uint64_t unasked = 0;
    std::uint64_t stockMissing = 0;
    std::uint64_t stockExtra = 0;
    std::string firstFault;
};

/// Runs the program to its end, or to a limit, with this process's streams. An interrupt from the keyboard is
/// for the program alone. Throws InputError when it cannot be started.
[[nodiscard]] TriedRun runTried(const TriedRunSettings& settings);

}  // namespace hashphase::demos
