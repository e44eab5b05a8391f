// SPDX-License-Identifier: Zlib
#pragma once

// A program that is tried, and its runs: each with a library preloaded, and a record that it fills.

#include <demos/report/provenance.hpp>
#include <demos/try/program_file.hpp>
#include <demos/try/record.hpp>
#include <demos/try/running_program.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

struct TriedRun {
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    RunEnd end;
    bool isLoaded = false;  // the library, into whatever ran
    tryout::Counts counts{};
    std::uint32_t droppedRows = 0;
    std::vector<tryout::StepRow> rows;  // steps; of a program that makes none, calculations
    tryout::Verification verification;  // of Broadphase::verifying

    [[nodiscard]] bool hasBroadphase() const { return counts.dbvts + counts.axisSweeps > 0; }
};

/// What was tried, and all runs of it, by turns: Bullet's, ours, Bullet's, ours; or a verified one.
struct Trial {
    std::string commandLine;
    TriedProgram program;
    std::vector<TriedRun> runs;
    Provenance provenance;
};

struct TriedRunSettings {
    ProgramCall call;                   // whose environment is this process's
    std::vector<std::string> preloads;  // paths of libraries, the first one first
    tryout::Broadphase broadphase = tryout::Broadphase::stock;
    std::int64_t inputBegin = -1;  // where its input begins; negative: in no file
};

/// Runs the program with this process's streams, of which the input begins where it is told. Throws InputError
/// when it cannot be started.
[[nodiscard]] TriedRun runTried(const TriedRunSettings& settings);

}  // namespace hashphase::demos
