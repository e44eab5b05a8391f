// SPDX-License-Identifier: Zlib
#pragma once

// Loops that you may run on several threads.

#include <broadphase/function_ref.hpp>

#include <cstddef>

namespace hashphase {

/// The body of a loop: runs iterations `begin` to `end` - 1.
using LoopBody = FunctionRef<void(std::size_t begin, std::size_t end)>;

/// Runs iterations 0 to count - 1, and returns when all are done. Calls body(begin, end) in any order, on any
/// threads. Each iteration is in exactly one range. A range has about `grain` iterations or more. A
/// `grain` of 0 means 1.
///
/// Write your own loop for any task system, or use bulletFor (bullet_parallel_for.hpp) or tbbFor
/// (tbb_parallel_for.hpp). All give the same results. For speed, always cut the same count into the same ranges, and
/// run each range on the same thread: its cache holds the data.
using ParallelFor = FunctionRef<void(std::size_t count, std::size_t grain, LoopBody body)>;

/// The serial loop: all iterations in one call, on the caller's thread.
inline void serialFor(std::size_t count, std::size_t /*grain*/, LoopBody body) {
    if (count > 0) {
        body(0, count);
    }
}

}  // namespace hashphase
