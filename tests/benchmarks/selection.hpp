// SPDX-License-Identifier: Zlib
#pragma once

// From what was asked for on the command line to the cases to run.

#include <tests/benchmarks/measurement.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hashphase::benchmarks {

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

/// Throws InputError for unknown contestants, bad expressions, and when nothing is chosen. The cases
/// point into `benchmarks`.
[[nodiscard]] std::vector<Case> selectCases(const std::vector<Benchmark>& benchmarks,
                                            const std::vector<ContestantKind>& kinds,
                                            const BenchmarkOptions& options);

}  // namespace hashphase::benchmarks
