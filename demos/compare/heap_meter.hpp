// SPDX-License-Identifier: Zlib
#pragma once

// How much memory calls take from the heap for good.

#include <cstdint>
#include <optional>

namespace hashphase::demos {

/// Bytes that the program has allocated and not freed; nothing where the C library does not tell.
[[nodiscard]] std::optional<std::int64_t> heapBytes() noexcept;

/// Adds up the heap's growth while a HeapScope is open.
class HeapMeter {
public:
    /// Nothing where the C library does not tell, or more was freed than taken: then the calls freed what others
    /// had allocated.
    [[nodiscard]] std::optional<std::int64_t> bytes() const noexcept;

private:
    friend class HeapScope;
    std::int64_t grown_ = 0;
};

class HeapScope {
public:
    explicit HeapScope(HeapMeter& meter) noexcept : meter_(meter), before_(heapBytes()) {}
    HeapScope(const HeapScope&) = delete;
    HeapScope& operator=(const HeapScope&) = delete;
    ~HeapScope();

private:
    HeapMeter& meter_;
    std::optional<std::int64_t> before_;
};

}  // namespace hashphase::demos
