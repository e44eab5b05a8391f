// SPDX-License-Identifier: Zlib
#pragma once

// Runs a program of somebody's twice, with Bullet's broadphase and with ours, and says what that makes of its
// steps; or once with both, to verify the pairs.

#include <demos/console/program.hpp>
#include <demos/report/provenance.hpp>
#include <demos/try/program_file.hpp>
#include <demos/try/tried_run.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct TryOptions {
    std::vector<std::string> words;  // the program and its arguments
    bool verify = false;
    std::optional<BulletPrecision> precision;
    std::optional<std::uint32_t> steps;
    std::optional<double> seconds;
    int runs = 1;
    std::string jsonFile;
    bool quiet = false;
};

/// What was tried, and all runs of it, by turns: Bullet's, ours, Bullet's, ours; or a verified one.
struct Trial {
    std::string commandLine;
    TriedProgram program;
    std::vector<TriedRun> runs;
    Provenance provenance;  // after them: how busy the machine was
};

/// Exit codes: kExitCheckFailed when pairs of ours were wrong, when nothing was verified or a verified run ended
/// by a crash, when the program ended in another way with ours than with Bullet's, or a later run of it made no
/// broadphase; kExitUsage when the first did not; 128 and a signal's number when that has ended the trial.
/// Throws InputError.
int runTry(const TryOptions& options, Console& console);

}  // namespace hashphase::demos
