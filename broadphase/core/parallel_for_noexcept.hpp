// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/parallel_for.hpp>

#include <cstddef>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// parallelFor(count, grain, body), for a body that may do all twice and throws nothing: where the loop cannot
/// be run on several threads for want of memory, it is run on this one.
inline void parallelForNoexcept(ParallelFor parallelFor, std::size_t count, std::size_t grain,
                                LoopBody body) noexcept {
    try {
        parallelFor(count, grain, body);
    } catch (...) {
        serialFor(count, grain, body);
    }
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
