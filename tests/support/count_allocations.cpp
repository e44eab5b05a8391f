// SPDX-License-Identifier: Zlib
#include <tests/support/count_allocations.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

namespace hashphase::test {
namespace {

std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> releases{0};
std::atomic<std::size_t> bytes{0};

// How many allocations are still to work; negative where all are.
std::atomic<std::int64_t> allowance{-1};

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

std::size_t bytesHeld() noexcept {
    return bytes;
}

std::int64_t FailingAllocations::allow(std::int64_t count) noexcept {
    return allowance.exchange(count);
}

void* countedAllocate(std::size_t size) {
    ++allocations;
    return std::malloc(size);
}

// Before each aligned block stands its size, and before that where what was allocated begins.
struct BlockHead {
    std::size_t size;
    void* memory;
};
constexpr std::size_t kUsualAlignment = 16;
static_assert(alignof(std::max_align_t) <= kUsualAlignment);

[[maybe_unused]] static void* allocate(std::size_t size, std::size_t alignment) {
    if (isRefused()) {
        return nullptr;
    }
    ++allocations;
    std::size_t space = size + alignment;
    void* const memory = std::malloc(sizeof(BlockHead) + space);
    if (memory == nullptr) {
        return nullptr;
    }
    bytes += size;
    void* block = static_cast<char*>(memory) + sizeof(BlockHead);
    std::align(alignment, size, block, space);
    const BlockHead head{size, memory};
    std::memcpy(static_cast<char*>(block) - sizeof(head), &head, sizeof(head));
    return block;
}

[[maybe_unused]] static void release(void* block) noexcept {
    if (block == nullptr) {
        return;
    }
    BlockHead head{};
    std::memcpy(&head, static_cast<char*>(block) - sizeof(head), sizeof(head));
    bytes -= head.size;
    ++releases;
    std::free(head.memory);
}

}  // namespace hashphase::test

#if !HASHPHASE_IS_SANITIZED && !HASHPHASE_KEEPS_NEW

using hashphase::test::kUsualAlignment;

// Not inlined: compilers take free() for a mismatch where they see only one half of the pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* block = hashphase::test::allocate(size, kUsualAlignment)) {
        return block;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    if (void* block = hashphase::test::allocate(size, static_cast<std::size_t>(alignment))) {
        return block;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return hashphase::test::allocate(size, kUsualAlignment);
}
// That of the library calls ours, but not under Valgrind, which puts its own there.
[[gnu::noinline]] void* operator new[](std::size_t size) {
    return operator new(size);
}
[[gnu::noinline]] void operator delete(void* block, std::align_val_t) noexcept {
    hashphase::test::release(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    hashphase::test::release(block);
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
    hashphase::test::release(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
    hashphase::test::release(block);
}
[[gnu::noinline]] void operator delete[](void* block) noexcept {
    operator delete(block);
}
[[gnu::noinline]] void operator delete[](void* block, std::size_t) noexcept {
    operator delete(block);
}

#endif
