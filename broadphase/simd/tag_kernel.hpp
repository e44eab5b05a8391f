// SPDX-License-Identifier: Zlib
#pragma once

// Sixteen bytes at once against one: where a group of a hash table is searched. The scalar version is
// the definition; the vector version gives the same bits.

#include <broadphase/export.hpp>

#include <cstdint>

#if defined(__SSE2__) && !HASHPHASE_USE_SCALAR
#include <emmintrin.h>
#endif

namespace hashphase::detail {

/// Bit k of the result tells whether tags[k] equals `tag`, for k below 16.
[[nodiscard]] inline std::uint32_t tagMaskScalar(const unsigned char* tags,
                                                 unsigned char tag) noexcept {
    std::uint32_t mask = 0;
    for (std::uint32_t k = 0; k < 16; ++k) {
        mask |= (tags[k] == tag ? 1U : 0U) << k;
    }
    return mask;
}

/// The same; `tags` lie at a multiple of 16.
[[nodiscard]] inline std::uint32_t tagMask(const unsigned char* tags, unsigned char tag) noexcept {
#if defined(__SSE2__) && !HASHPHASE_USE_SCALAR
    const __m128i all = _mm_load_si128(reinterpret_cast<const __m128i*>(tags));
    const __m128i isEqual = _mm_cmpeq_epi8(all, _mm_set1_epi8(static_cast<char>(tag)));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(isEqual));
#else
    return tagMaskScalar(tags, tag);
#endif
}

}  // namespace hashphase::detail
