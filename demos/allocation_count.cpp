// SPDX-License-Identifier: Zlib
//
// A `new` that counts, for the program alone: a test program has one of its own.

#include <demos/allocation_count.hpp>

#include <broadphase/core/compiler.hpp>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

namespace hashphase::demos {
namespace {

std::atomic<std::size_t> count{0};

}  // namespace

std::size_t allocationCount() noexcept {
    return count.load(std::memory_order_relaxed);
}

}  // namespace hashphase::demos

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[HASHPHASE_NO_INLINE]] void* operator new(std::size_t size) {
    hashphase::demos::count.fetch_add(1, std::memory_order_relaxed);
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
// Before an aligned block stands where what was allocated begins. (Windows has no aligned_alloc().)
[[HASHPHASE_NO_INLINE]] void* operator new(std::size_t size, std::align_val_t alignment) {
    hashphase::demos::count.fetch_add(1, std::memory_order_relaxed);
    std::size_t space = size + static_cast<std::size_t>(alignment);
    if (void* const memory = std::malloc(sizeof(memory) + space)) {
        void* block = static_cast<char*>(memory) + sizeof(memory);
        std::align(static_cast<std::size_t>(alignment), size, block, space);
        std::memcpy(static_cast<char*>(block) - sizeof(memory), &memory, sizeof(memory));
        return block;
    }
    throw std::bad_alloc();
}
[[HASHPHASE_NO_INLINE]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[HASHPHASE_NO_INLINE]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
[[HASHPHASE_NO_INLINE]] void operator delete(void* block, std::align_val_t) noexcept {
    if (block != nullptr) {
        void* memory = nullptr;
        std::memcpy(&memory, static_cast<char*>(block) - sizeof(memory), sizeof(memory));
        std::free(memory);
    }
}
[[HASHPHASE_NO_INLINE]] void operator delete(void* block, std::size_t,
                                             std::align_val_t alignment) noexcept {
    operator delete(block, alignment);
}
