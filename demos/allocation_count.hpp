// SPDX-License-Identifier: Zlib
#pragma once

#include <cstddef>

namespace hashphase::demos {

/// How often the program has called `new`, on all threads.
[[nodiscard]] std::size_t allocationCount() noexcept;

/// It, or null where a sanitizer brings a `new` of its own.
#if HASHPHASE_COUNTS_ALLOCATIONS
inline constexpr auto kAllocationCount = allocationCount;
#else
inline constexpr std::size_t (*kAllocationCount)() = nullptr;
#endif

}  // namespace hashphase::demos
