// SPDX-License-Identifier: Zlib
#include <broadphase/core/parallel_for_noexcept.hpp>

#include <broadphase/core/caught.hpp>

namespace hashphase::detail {

void parallelForNoexcept(ParallelFor parallelFor, std::size_t count, std::size_t grain,
                         LoopBody body) noexcept {
    if (exceptionOf([&] { parallelFor(count, grain, body); }) != nullptr) {
        serialFor(count, grain, body);
    }
}

}  // namespace hashphase::detail
