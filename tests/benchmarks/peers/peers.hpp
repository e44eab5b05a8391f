// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases of other libraries, one library a file. A library that was not found when this was
// built has no contestants.
//
// Same for all   Each is handed exactly the boxes of the scene, told only of those that changed where
//                it can make use of that, and writes its pairs to a list: that is its complete set.

#include <broadphase/parallel_for.hpp>
#include <tests/benchmarks/contestant.hpp>

namespace hashphase::benchmarks {

[[nodiscard]] std::vector<ContestantKind> cgalKinds();
[[nodiscard]] std::vector<ContestantKind> fclKinds();
[[nodiscard]] std::vector<ContestantKind> odeKinds();

/// Ours, on the threads of oneTBB.
[[nodiscard]] std::vector<ContestantKind> threadedKinds();

/// A ParallelFor on the threads of oneTBB; null where it was not found.
using Loop = void(std::size_t count, std::size_t grain, LoopBody body);
[[nodiscard]] Loop* threadedLoop();

}  // namespace hashphase::benchmarks
