// SPDX-License-Identifier: Zlib
#include <broadphase/core/parallel_for_noexcept.hpp>

namespace hashphase::detail {

void parallelForNoexcept(ParallelFor parallelFor, std::size_t count, std::size_t grain,
                         LoopBody body) noexcept {
    try {
        parallelFor(count, grain, body);
    } catch (...) {
        serialFor(count, grain, body);
    }
}

}  // namespace hashphase::detail
