// SPDX-License-Identifier: Zlib
#pragma once

// Counts every `new` of a program that count_allocations.cpp is a part of.

#include <cstddef>

namespace hashphase::test {

// Sanitizers have a `new` of their own, which finds faults that another one would hide.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kCountsAllocations = false;
#else
inline constexpr bool kCountsAllocations = true;
#endif

/// So far; always 0 where none are counted.
[[nodiscard]] std::size_t allocationCount() noexcept;

/// malloc(), counted, for libraries that take a function to allocate by.
[[nodiscard]] void* countedAllocate(std::size_t size);

}  // namespace hashphase::test
