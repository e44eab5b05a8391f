// SPDX-License-Identifier: Zlib
#pragma once

// Runs the grid's loops on the threads of oneTBB (2021 or newer). Link TBB::tbb.

#include <broadphase/parallel_for.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace hashphase {

/// A ParallelFor: pairs.update(filter, hashphase::tbbFor). Idle threads sleep. Loops are split evenly. As a result, a
/// thread mostly reads data that its processor cache holds from an earlier loop.
inline void tbbFor(std::size_t count, std::size_t grain, LoopBody body) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(grain, 1)),
        [&body](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); },
        tbb::static_partitioner());
}

}  // namespace hashphase
