// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase stability`: runs hard cases with our broadphase and Bullet's, each in a process of its own,
// and says what each one does.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/console/program.hpp>
#include <demos/report/provenance.hpp>
#include <demos/stability/hard_case.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct StabilityOptions {
    std::vector<std::string> only;         // ids; empty: all
    std::vector<std::string> broadphases;  // names; empty: all
    bool isQuick = false;
    bool isExplained = false;
    std::uint64_t seed = 1;
    double caseSeconds = 2;           // of processor time for a case; ours has ten times that
    std::optional<double> timeLimit;  // [s] of wall time, after which no case begins
    std::string jsonFile;             // empty: none is written
    std::string csvFile;
    std::string htmlFile;
    bool quiet = false;
    bool list = false;
};

/// What all broadphases do in one case.
struct CaseResult {
    const HardCase* hardCase = nullptr;
    std::vector<CaseOutcome> outcomes;  // as many as StabilityReport::kinds
    double seconds = 0;                 // of wall time
};

struct StabilityReport {
    StabilityOptions options;
    std::vector<const BroadphaseKind*> kinds;
    std::vector<CaseResult> results;
    std::vector<std::string> leftOut;  // ids, for want of time
    Provenance provenance;
    double seconds = 0;
};

/// Runs the cases, prints the table, writes the files, and returns the exit code: kExitCheckFailed
/// when ours is not as required in one. Throws InputError for unknown ids and for files that cannot
/// be written.
int runStability(const StabilityOptions& options, std::span<const BroadphaseKind> kinds,
                 std::span<const HardCase> cases, Console& console);

/// Whether ours is as required; nothing where ours was not asked.
[[nodiscard]] std::optional<bool> caseHolds(const StabilityReport& report,
                                            const CaseResult& result);

/// Whether ours is as required wherever it was asked.
[[nodiscard]] bool allHold(const StabilityReport& report);

/// One sentence: in how many cases ours is as required, and in how many each other one is not.
[[nodiscard]] std::string verdictLine(const StabilityReport& report);

}  // namespace hashphase::demos
