// SPDX-License-Identifier: Zlib
#pragma once

// The threads that scenes are simulated on: those of oneTBB, where it was found when the program was built.

#include <broadphase/parallel_for.hpp>

#include <cstddef>
#include <memory>

namespace hashphase::demos {

/// A ParallelFor.
void stageFor(std::size_t count, std::size_t grain, LoopBody body);

/// How many there are at most: 1 without oneTBB.
[[nodiscard]] std::size_t threadCount();

/// While what is returned lives, there are at most so many.
[[nodiscard]] std::shared_ptr<void> limitThreads(std::size_t count);

}  // namespace hashphase::demos
