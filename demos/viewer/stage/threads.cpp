// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/threads.hpp>

#if HASHPHASE_HAS_TBB
#include <integration/tbb/tbb_parallel_for.hpp>

#include <tbb/global_control.h>

namespace hashphase::demos {

void stageFor(std::size_t count, std::size_t grain, LoopBody body) {
    tbbFor(count, grain, body);
}

std::size_t threadCount() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

struct ThreadLimit::Control {
    explicit Control(std::size_t count)
        : control(tbb::global_control::max_allowed_parallelism, count) {}
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(std::size_t count) : control_(std::make_unique<Control>(count)) {}

}  // namespace hashphase::demos
#else
namespace hashphase::demos {

void stageFor(std::size_t count, std::size_t grain, LoopBody body) {
    serialFor(count, grain, body);
}

std::size_t threadCount() {
    return 1;
}

struct ThreadLimit::Control {};

ThreadLimit::ThreadLimit(std::size_t /*count*/) {}

}  // namespace hashphase::demos
#endif

namespace hashphase::demos {

ThreadLimit::~ThreadLimit() = default;

}  // namespace hashphase::demos
