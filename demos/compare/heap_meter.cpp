// SPDX-License-Identifier: Zlib
#include <demos/compare/heap_meter.hpp>

#include <cstdlib>

// mallinfo2 came with glibc 2.33; sanitizers put their own allocator in its place.
#if HASHPHASE_HAS_MALLINFO2 && !HASHPHASE_IS_SANITIZED
#include <malloc.h>
#endif

namespace hashphase::demos {

std::optional<std::int64_t> heapBytes() noexcept {
#if HASHPHASE_HAS_MALLINFO2 && !HASHPHASE_IS_SANITIZED
    const struct mallinfo2 info = mallinfo2();
    return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
#else
    return std::nullopt;
#endif
}

std::optional<std::int64_t> HeapMeter::bytes() const noexcept {
    return heapBytes() && grown_ >= 0 ? std::optional(grown_) : std::nullopt;
}

HeapScope::~HeapScope() {
    if (before_) {
        meter_.grown_ += *heapBytes() - *before_;
    }
}

}  // namespace hashphase::demos
