// SPDX-License-Identifier: Zlib
#pragma once

// Runs the loops of the broadphase on the threads of Bullet's task scheduler: see btSetTaskScheduler().
//
// Scheduler If no scheduler is set, loops run on the caller's thread. A Bullet built without BT_THREADSAFE has no
//           scheduler, but you can set your own.
// Lifetime  Never delete the result of btCreateDefaultTaskScheduler(): its destructor may overwrite memory of the
//           program (a bug in btThreadSupportPosix::waitForResponse()).

#include <broadphase/core/first_exception.hpp>
#include <broadphase/parallel_for.hpp>

#include <LinearMath/btThreads.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A ParallelFor. To use it in a broadphase, set SpatialHashConfig::parallelFor to hashphase::bulletFor. If the loop
/// throws, for example std::bad_alloc, waits for all threads, and rethrows the first exception on the caller's
/// thread.
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
    if (scheduler == nullptr || count > kMost) {  // Bullet counts with int
        body(0, count);
    } else {
        detail::FirstException exception;
        // btParallelFor() would use threads only in a Bullet with BT_THREADSAFE.
        scheduler->parallelFor(0, static_cast<int>(count),
                               static_cast<int>(std::clamp<std::size_t>(grain, 1, kMost)),
                               Body(body, exception));
        exception.rethrow();
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
