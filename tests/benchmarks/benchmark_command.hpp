// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>
#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// The program over the given contestants. Exit code: kExitCheckFailed when an answer of ours was
/// wrong.
[[nodiscard]] demos::Subcommand benchmarkCommand(
    std::vector<ContestantKind> kinds = contestantKinds());

}  // namespace hashphase::benchmarks
