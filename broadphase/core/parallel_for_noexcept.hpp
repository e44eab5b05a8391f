// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <broadphase/parallel_for.hpp>

#include <cstddef>

namespace hashphase::detail {

/// parallelFor(count, grain, body), for a body that may do all twice and throws nothing: where the loop cannot
/// be run on several threads for want of memory, it is run on this one.
HASHPHASE_BROADPHASE_EXPORT void parallelForNoexcept(ParallelFor parallelFor, std::size_t count,
                                                     std::size_t grain, LoopBody body) noexcept;

}  // namespace hashphase::detail
