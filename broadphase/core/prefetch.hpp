// SPDX-License-Identifier: Zlib
#pragma once

namespace hashphase::detail {

/// Begins to fetch what lies there into the processor's cache. Any address will do, also null.
inline void prefetch(const void* address) noexcept {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    static_cast<void>(address);
#endif
}

}  // namespace hashphase::detail
