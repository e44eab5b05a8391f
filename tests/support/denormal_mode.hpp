// SPDX-License-Identifier: Zlib
#pragma once

// Whether this thread's processor takes denormal numbers for zero.

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace hashphase::test {

/// Sets the mode of this thread while it lives: flush-to-zero and denormals-are-zero, or neither.
class DenormalMode {
public:
#if defined(__SSE2__)
    static constexpr bool kIsKnown = true;

    explicit DenormalMode(bool isFlushed) : before_(_mm_getcsr()) {
        _mm_setcsr(isFlushed ? before_ | kFlush : before_ & ~kFlush);
    }
    ~DenormalMode() {
        _mm_setcsr(before_);
    }

private:
    static constexpr unsigned kFlush = 0x8040;  // both bits of the control register
    unsigned before_;

public:
#else
    static constexpr bool kIsKnown = false;
    explicit DenormalMode(bool /*isFlushed*/) {}
#endif
    DenormalMode(const DenormalMode&) = delete;
    DenormalMode& operator=(const DenormalMode&) = delete;
};

}  // namespace hashphase::test
