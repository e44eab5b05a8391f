// SPDX-License-Identifier: Zlib
#pragma once

// Sixteen bytes at once against one: where a group of a hash table is searched. The scalar version is
// the definition; the vector versions give the same bits.

#include <broadphase/core/compiler.hpp>
#include <broadphase/export.hpp>

#include <cstdint>

#if HASHPHASE_USE_SCALAR
#elif HASHPHASE_HAS_SSE2
#include <emmintrin.h>
#elif HASHPHASE_HAS_NEON
#include <arm_neon.h>
#elif HASHPHASE_HAS_SIMD128
#include <wasm_simd128.h>
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
#if HASHPHASE_USE_SCALAR
    return tagMaskScalar(tags, tag);
#elif HASHPHASE_HAS_SSE2
    const __m128i all = _mm_load_si128(reinterpret_cast<const __m128i*>(tags));
    const __m128i isEqual = _mm_cmpeq_epi8(all, _mm_set1_epi8(static_cast<char>(tag)));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(isEqual));
#elif HASHPHASE_HAS_NEON
    // The bits of bytes k and k + 8 side by side, and added up by halves.
    alignas(16) static constexpr unsigned char kBits[16] = {1, 2, 4, 8, 16, 32, 64, 128,
                                                            1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t isEqual = vceqq_u8(vld1q_u8(tags), vdupq_n_u8(tag));
    const uint8x16_t bits = vandq_u8(isEqual, vld1q_u8(kBits));
    const uint8x16_t pairs = vzip1q_u8(bits, vextq_u8(bits, bits, 8));
    return vaddvq_u16(vreinterpretq_u16_u8(pairs));
#elif HASHPHASE_HAS_SIMD128
    const v128_t isEqual =
        wasm_i8x16_eq(wasm_v128_load(tags), wasm_i8x16_splat(static_cast<std::int8_t>(tag)));
    return wasm_i8x16_bitmask(isEqual);
#else
    return tagMaskScalar(tags, tag);
#endif
}

}  // namespace hashphase::detail
