// SPDX-License-Identifier: Zlib
#pragma once

// Runs the loops of the broadphase on the threads of Bullet's task scheduler: see btSetTaskScheduler().
// Without a scheduler they run on the caller's thread. A Bullet built without threads (BT_THREADSAFE) has none
// to offer, but takes a scheduler of the program's own.
//
// Keep what btCreateDefaultTaskScheduler() gave until the program ends. Its destructor at times writes a zero before
// an array of its own, where there may be anything of the program's: btThreadSupportPosix::waitForResponse() takes
// the end of a thread's earlier work for that of its present one, and then finds no thread that has ended.

#include <broadphase/core/first_exception.hpp>
#include <broadphase/parallel_for.hpp>

#include <LinearMath/btThreads.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A ParallelFor: config.parallelFor = hashphase::bulletFor. What a thread of Bullet's throws, as std::bad_alloc,
/// is thrown on the caller's when all have ended.
inline void bulletFor(std::size_t count, std::size_t grain, LoopBody body) {
    struct Body : btIParallelForBody {
        const LoopBody& loop;
        detail::FirstException& exception;

        Body(const LoopBody& itsLoop, detail::FirstException& ofAny)
            : loop(itsLoop), exception(ofAny) {}
        void forLoop(int begin, int end) const override {
            exception.run(loop, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
        }
    };
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    if (count == 0) {
        return;
    }
    btITaskScheduler* const scheduler = btGetTaskScheduler();
    if (scheduler == nullptr || count > kMost) {  // more than Bullet can count
        body(0, count);
    } else {
        detail::FirstException exception;
        // btParallelFor() is for a Bullet with threads alone.
        scheduler->parallelFor(0, static_cast<int>(count),
                               static_cast<int>(std::clamp<std::size_t>(grain, 1, kMost)),
                               Body(body, exception));
        exception.rethrow();
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
