// SPDX-License-Identifier: Zlib
#include <tests/support/count_allocations.hpp>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace hashphase::test {
namespace {

std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> releases{0};

// How many allocations are still to work; negative where all are.
constexpr std::int64_t kUnlimited = -1;
std::atomic<std::int64_t> allowance{kUnlimited};

// Says whether this allocation is to fail. (Under sanitizers, nobody asks.)
[[maybe_unused]] bool isRefused() noexcept {
    std::int64_t left = allowance.load(std::memory_order_relaxed);
    while (left > 0 && !allowance.compare_exchange_weak(left, left - 1)) {
    }
    return left == 0;
}

}  // namespace

std::size_t allocationCount() noexcept {
    return allocations;
}

std::size_t blocksHeld() noexcept {
    return allocations - releases;
}

FailingAllocations::FailingAllocations(std::size_t after) noexcept
    : before_(allowance.exchange(static_cast<std::int64_t>(after))) {}

FailingAllocations::~FailingAllocations() {
    allowance = before_;
}

WorkingAllocations::WorkingAllocations() noexcept : before_(allowance.exchange(kUnlimited)) {}

WorkingAllocations::~WorkingAllocations() {
    allowance = before_;
}

void* countedAllocate(std::size_t size) {
    ++allocations;
    return std::malloc(size);
}

// Of what either kind of `new` has returned.
[[maybe_unused]] static void release(void* memory) noexcept {
    releases += memory != nullptr ? 1 : 0;
    std::free(memory);
}

}  // namespace hashphase::test

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (hashphase::test::isRefused()) {
        throw std::bad_alloc();
    }
    if (void* memory = hashphase::test::countedAllocate(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    if (hashphase::test::isRefused()) {
        throw std::bad_alloc();
    }
    ++hashphase::test::allocations;
    const auto step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return hashphase::test::isRefused() ? nullptr
                                        : hashphase::test::countedAllocate(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    hashphase::test::release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    hashphase::test::release(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    hashphase::test::release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    hashphase::test::release(memory);
}

#endif
