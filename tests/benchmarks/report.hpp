// SPDX-License-Identifier: Zlib
#pragma once

// What was measured, as text for people and as JSON for programs.

#include <demos/report/provenance.hpp>
#include <tests/benchmarks/selection.hpp>

#include <iosfwd>

namespace hashphase::benchmarks {

/// All that the reports say.
struct BenchmarkReport {
    BenchmarkOptions options;
    MeasurementSettings settings;
    demos::Provenance provenance;
    std::vector<CaseResult> cases;
    std::size_t casesAsked = 0;
};

/// On what machine, with which flags and versions, and how to read what follows.
void printSetting(const BenchmarkReport& report, const std::vector<ContestantKind>& kinds,
                  std::ostream& out);

/// One case, as soon as it is done.
void printCase(const CaseResult& result, std::ostream& out);

/// All cases in a table, the spread of the random scenes, the regret of the cell sizes, what
/// declared effects cost, the verdict.
void printSummary(const BenchmarkReport& report, std::ostream& out);

/// True when no checked answer of ours was wrong in any case.
[[nodiscard]] bool oursWereExact(const BenchmarkReport& report);

/// Schema "hashphase-benchmarks"; what was not measured is null.
void writeJson(const BenchmarkReport& report, std::ostream& out);

}  // namespace hashphase::benchmarks
