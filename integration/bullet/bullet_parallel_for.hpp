// SPDX-License-Identifier: Zlib
#pragma once

// Runs the loops of the broadphase on the threads of Bullet's task scheduler: see btSetTaskScheduler().
//
// Scheduler Without one, loops run on the caller's thread. A Bullet without threads (BT_THREADSAFE) has none, but
//           takes your own.
// Lifetime  Keep the result of btCreateDefaultTaskScheduler() until the program ends: its destructor may overwrite
//           memory of the program (a fault in btThreadSupportPosix::waitForResponse()).

#include <broadphase/core/first_exception.hpp>
#include <broadphase/parallel_for.hpp>

#include <LinearMath/btThreads.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A ParallelFor: config.parallelFor = hashphase::bulletFor. Throws on the caller's thread, after all threads have
/// ended, the first exception of the loop, such as std::bad_alloc.
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
        // btParallelFor() needs a Bullet with threads.
        scheduler->parallelFor(0, static_cast<int>(count),
                               static_cast<int>(std::clamp<std::size_t>(grain, 1, kMost)),
                               Body(body, exception));
        exception.rethrow();
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
