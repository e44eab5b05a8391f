// SPDX-License-Identifier: Zlib
#pragma once

// Counts every `new` of a program that count_allocations.cpp is a part of, and makes it fail on demand.

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace hashphase::test {

// Sanitizers have a `new` of their own, which finds faults that another one would hide; DLLs, too.
#if HASHPHASE_IS_SANITIZED || HASHPHASE_KEEPS_NEW
inline constexpr bool kCountsAllocations = false;
#else
inline constexpr bool kCountsAllocations = true;
#endif

/// So far; always 0 where none are counted.
[[nodiscard]] std::size_t allocationCount() noexcept;

/// How many blocks are held at the moment; always 0 where none are counted.
[[nodiscard]] std::size_t blocksHeld() noexcept;

/// How many bytes `new` was asked for that are held at the moment; always 0 where none are counted.
[[nodiscard]] std::size_t bytesHeld() noexcept;

/// While it lives, `new` works so many times more, on all threads together, and then throws
/// std::bad_alloc. Does nothing where none are counted.
class FailingAllocations {
public:
    template <std::integral Count>
    explicit FailingAllocations(Count after) noexcept
        : before_(allow(static_cast<std::int64_t>(after))) {}
    ~FailingAllocations() { allow(before_); }
    FailingAllocations(const FailingAllocations&) = delete;
    FailingAllocations& operator=(const FailingAllocations&) = delete;

private:
    /// So many are to work, all where that is negative; returns how many were.
    static std::int64_t allow(std::int64_t count) noexcept;

    std::int64_t before_;
};

/// While it lives, `new` works, within the life of FailingAllocations too: for a test's own lists.
struct WorkingAllocations : private FailingAllocations {
    WorkingAllocations() noexcept : FailingAllocations(-1) {}
};

/// malloc(), counted, for libraries that take a function to allocate by.
[[nodiscard]] void* countedAllocate(std::size_t size);

}  // namespace hashphase::test
