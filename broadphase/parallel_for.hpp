// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/function_ref.hpp>

#include <cstddef>

namespace hashphase {

/// Part of a loop: the iterations from `begin` up to, but not including, `end`.
using LoopBody = FunctionRef<void(std::size_t begin, std::size_t end)>;

/// Runs iterations 0 to count - 1: calls body(begin, end) for ranges that cover each iteration once, of about
/// `grain` iterations or more (0 is taken as 1), in any order and on any threads. Returns when all are done.
/// Write your own over any task system, or take bulletFor (bullet_parallel_for.hpp) or tbbFor
/// (tbb_parallel_for.hpp). A function with a ParallelFor parameter has the same results under all of them. One that
/// cuts equal counts equally, and gives equal ranges to the same threads, is the fastest: each then finds in its own
/// cache what it has written.
using ParallelFor = FunctionRef<void(std::size_t count, std::size_t grain, LoopBody body)>;

/// The plain loop: all iterations in one call, on the caller's thread.
inline void serialFor(std::size_t count, std::size_t /*grain*/, LoopBody body) {
    if (count > 0) {
        body(0, count);
    }
}

}  // namespace hashphase
