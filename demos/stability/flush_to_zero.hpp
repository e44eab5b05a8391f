// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/compiler.hpp>

#if HASHPHASE_HAS_SSE2
#include <immintrin.h>
#endif

namespace hashphase::demos {

/// While it lives, this thread takes denormal numbers for zero and makes none (FTZ and DAZ), or it
/// does not, as games set their processors.
class FlushToZero {
public:
#if HASHPHASE_HAS_SSE2
    explicit FlushToZero(bool flushes) : before_(_mm_getcsr()) {
        _mm_setcsr(flushes ? before_ | kBoth : before_ & ~kBoth);
    }
    ~FlushToZero() {
        _mm_setcsr(before_);
    }
    [[nodiscard]] static constexpr bool isAvailable() noexcept {
        return true;
    }
#else
    explicit FlushToZero(bool /*flushes*/) {}
    [[nodiscard]] static constexpr bool isAvailable() noexcept {
        return false;
    }
#endif
    FlushToZero(const FlushToZero&) = delete;
    FlushToZero& operator=(const FlushToZero&) = delete;

private:
    static constexpr unsigned kBoth = 0x8040;
    [[maybe_unused]] unsigned before_ = 0;
};

}  // namespace hashphase::demos
