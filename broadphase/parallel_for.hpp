// SPDX-License-Identifier: Zlib
#pragma once

// Loops that callers may run on several threads.

#include <broadphase/function_ref.hpp>

#include <cstddef>

namespace hashphase {

/// The body of a loop: runs iterations `begin` to `end` - 1.
using LoopBody = FunctionRef<void(std::size_t begin, std::size_t end)>;

/// Runs iterations 0 to count - 1, and returns when all are done. Calls body(begin, end) for ranges that cover each
/// iteration once, of about `grain` iterations or more (0 means 1), in any order, on any threads. Write your own over
/// any task system, or use bulletFor (bullet_parallel_for.hpp) or tbbFor (tbb_parallel_for.hpp). Results are the same
/// under all of them. Fastest: give equal ranges of equal counts to the same threads, whose caches then hold what
/// they wrote.
using ParallelFor = FunctionRef<void(std::size_t count, std::size_t grain, LoopBody body)>;

/// The plain loop: all iterations in one call, on the caller's thread.
inline void serialFor(std::size_t count, std::size_t /*grain*/, LoopBody body) {
    if (count > 0) {
        body(0, count);
    }
}

}  // namespace hashphase
