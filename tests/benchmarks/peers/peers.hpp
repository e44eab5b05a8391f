// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases of other libraries, one library a file. A library that was not found when this was
// built has no contestants.
//
// Same for all   Each is handed exactly the boxes of the scene, told only of those that changed where
//                it can make use of that, and writes its pairs to a list: that is its complete set.

#include <broadphase/parallel_for.hpp>
#include <tests/benchmarks/contestant.hpp>
#include <tests/benchmarks/crowd.hpp>

#include <optional>

namespace hashphase::benchmarks {

[[nodiscard]] std::vector<ContestantKind> cgalKinds();
[[nodiscard]] std::vector<ContestantKind> fclKinds();
[[nodiscard]] std::vector<ContestantKind> odeKinds();

/// Ours, on the threads of oneTBB.
[[nodiscard]] std::vector<ContestantKind> threadedKinds();

/// Loops on them.
[[nodiscard]] std::optional<ParallelFor> threadedLoop();

/// For crowds.
[[nodiscard]] std::vector<CrowdKind> nanoflannKinds();

}  // namespace hashphase::benchmarks
