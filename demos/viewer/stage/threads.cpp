// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/threads.hpp>

#if HASHPHASE_HAS_TBB
#include <integration/tbb/tbb_parallel_for.hpp>

#include <tbb/global_control.h>
#endif

namespace hashphase::demos {

#if HASHPHASE_HAS_TBB
using Limit = tbb::global_control;

void stageFor(std::size_t count, std::size_t grain, LoopBody body) {
    tbbFor(count, grain, body);
}

std::size_t threadCount() {
    return Limit::active_value(Limit::max_allowed_parallelism);
}

std::shared_ptr<void> limitThreads(std::size_t count) {
    return std::make_shared<Limit>(Limit::max_allowed_parallelism, count);
}
#else
void stageFor(std::size_t count, std::size_t grain, LoopBody body) {
    serialFor(count, grain, body);
}

std::size_t threadCount() {
    return 1;
}

std::shared_ptr<void> limitThreads(std::size_t /*count*/) {
    return nullptr;
}
#endif

}  // namespace hashphase::demos
