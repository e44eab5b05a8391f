// SPDX-License-Identifier: Zlib
#include <tests/support/count_allocations.hpp>

#include <atomic>
#include <cstdlib>
#include <new>

namespace hashphase::test {
namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

std::size_t allocationCount() noexcept {
    return allocations;
}

void* countedAllocate(std::size_t size) {
    ++allocations;
    return std::malloc(size);
}

}  // namespace hashphase::test

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* memory = hashphase::test::countedAllocate(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    ++hashphase::test::allocations;
    const auto step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

#endif
