// SPDX-License-Identifier: Zlib
#pragma once

// The program: what is asked of it, and what was measured as text for people and as JSON for programs.

#include <demos/console/program.hpp>
#include <demos/report/provenance.hpp>
#include <tests/benchmarks/measurement.hpp>

#include <iosfwd>
#include <optional>

namespace hashphase::benchmarks {

/// The program over the given contestants. Exit code: kExitCheckFailed when an answer of ours was
/// wrong.
[[nodiscard]] demos::Subcommand benchmarkCommand(
    std::vector<ContestantKind> kinds = contestantKinds());

struct BenchmarkOptions {
    std::vector<std::string> only;         // regular expressions; empty: all but those on request
    std::vector<std::size_t> sizes;        // empty: each benchmark's own
    std::vector<std::string> contestants;  // empty: all
    std::optional<int> frames;             // measured
    std::uint64_t seed = 1;
    std::optional<double> timeLimit;  // [s]
    std::string jsonFile;             // empty: none
    bool quick = false;               // small and few: checks, measures nothing worth reading
    bool quiet = false;               // no progress
    bool list = false;                // only say what there is
};

/// All that the reports say.
struct BenchmarkReport {
    BenchmarkOptions options;
    MeasurementSettings settings;
    demos::Provenance provenance;
    demos::Measurements measured;
    std::size_t casesAsked = 0;
    std::string stopped;  // why not all was measured: "The run was interrupted"
};

/// On what machine, with which flags and versions, and how to read what follows.
void printSetting(const BenchmarkReport& report, const std::vector<ContestantKind>& kinds,
                  std::ostream& out);

/// The case of that number, as soon as it is done.
void printCase(BenchmarkReport& report, std::int64_t number, std::ostream& out);

/// All cases in a table, the spread of the random scenes, the regret of the cell sizes, what
/// declared effects cost, the verdict: whether no checked answer of ours was wrong, which it returns.
bool printSummary(BenchmarkReport& report, std::ostream& out);

/// Schema "hashphase-benchmarks"; what was not measured is null. After printSummary().
void writeJson(BenchmarkReport& report, std::ostream& out);

}  // namespace hashphase::benchmarks
