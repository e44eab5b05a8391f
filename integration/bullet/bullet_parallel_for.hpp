// SPDX-License-Identifier: Zlib
#pragma once

// Runs the loops of the broadphase on the threads of Bullet's task scheduler: see btSetTaskScheduler().
// Without a scheduler, as in a Bullet built without threads, they run on the caller's thread.

#include <broadphase/parallel_for.hpp>

#include <LinearMath/btThreads.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A ParallelFor: config.parallelFor = hashphase::bulletFor.
inline void bulletFor(std::size_t count, std::size_t grain, LoopBody body) {
    struct Body : btIParallelForBody {
        const LoopBody& loop;

        explicit Body(const LoopBody& itsLoop) : loop(itsLoop) {}
        void forLoop(int begin, int end) const override {
            loop(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
        }
    };
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    if (count == 0) {
        return;
    }
    if (btGetTaskScheduler() == nullptr || count > kMost) {  // more than Bullet can count
        body(0, count);
    } else {
        btParallelFor(0, static_cast<int>(count),
                      static_cast<int>(std::clamp<std::size_t>(grain, 1, kMost)), Body(body));
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
