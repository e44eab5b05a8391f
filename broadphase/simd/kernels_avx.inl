// SPDX-License-Identifier: Zlib

// What the kernels for AVX2 and AVX-512 share.

template <class Scalar>
struct Pack;

template <>
struct Pack<float> {
    static constexpr std::uint32_t kWidth = 8;
    using Numbers = __m256;
    static Numbers load(const float* from) { return _mm256_loadu_ps(from); }
    static void store(float* to, Numbers a) { _mm256_storeu_ps(to, a); }
    static Numbers broadcast(float x) { return _mm256_set1_ps(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm256_sub_ps(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm256_add_ps(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm256_mul_ps(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm256_min_ps(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm256_max_ps(a, b); }
    static Numbers abs(Numbers a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), a); }
    static __m256 lessEqual(Numbers a, Numbers b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static __m256 bitAnd(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }
    static std::uint32_t bits(__m256 hits) {
        return static_cast<std::uint32_t>(_mm256_movemask_ps(hits));
    }
};

// Reckoned from the four bits: of a comparison Clang makes VTESTPS, which takes longer.
inline std::uint32_t notAllOfFour(int mask) {
    return (static_cast<std::uint32_t>(mask) + 1) >> 4 ^ 1;
}

inline std::uint32_t isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
    const __m128 one = _mm_cmp_ps(_mm_load_ps(a.low), _mm_load_ps(b.high), _CMP_LE_OQ);
    const __m128 other = _mm_cmp_ps(_mm_load_ps(b.low), _mm_load_ps(a.high), _CMP_LE_OQ);
    return notAllOfFour(_mm_movemask_ps(_mm_and_ps(one, other)));
}

inline std::uint32_t isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
    const __m256d one = _mm256_cmp_pd(_mm256_load_pd(a.low), _mm256_load_pd(b.high), _CMP_LE_OQ);
    const __m256d other = _mm256_cmp_pd(_mm256_load_pd(b.low), _mm256_load_pd(a.high), _CMP_LE_OQ);
    return notAllOfFour(_mm256_movemask_pd(_mm256_and_pd(one, other)));
}

inline void padCorners(const float* corners, PaddedBox<float>& box) {
    const __m128i low = _mm_castps_si128(_mm_loadu_ps(corners));
    const __m128i high = _mm_castps_si128(_mm_loadu_ps(corners + 2));
    _mm_store_ps(box.low, _mm_castsi128_ps(_mm_srli_si128(_mm_slli_si128(low, 4), 4)));
    _mm_store_ps(box.high, _mm_castsi128_ps(_mm_srli_si128(high, 4)));
}

inline void padCorners(const double* corners, PaddedBox<double>& box) {
    const __m256d high = _mm256_loadu_pd(corners + 2);
    const __m256d none = _mm256_setzero_pd();
    _mm256_store_pd(box.low, _mm256_blend_pd(_mm256_loadu_pd(corners), none, 0x8));
    _mm256_store_pd(box.high, _mm256_blend_pd(_mm256_permute4x64_pd(high, 0x39), none, 0x8));
}

// The arithmetic of quantise(), axes side by side.

inline bool fitsEdge(const Level<float>& level, const PaddedBox<float>& box) {
    const __m128 edges = _mm_sub_ps(_mm_load_ps(box.high), _mm_load_ps(box.low));
    return _mm_movemask_ps(_mm_cmp_ps(edges, _mm_set1_ps(level.largestEdge), _CMP_LE_OQ)) == 0xf;
}

inline bool fitsEdge(const Level<double>& level, const PaddedBox<double>& box) {
    const __m256d edges = _mm256_sub_pd(_mm256_load_pd(box.high), _mm256_load_pd(box.low));
    const __m256d largest = _mm256_set1_pd(level.largestEdge);
    return _mm256_movemask_pd(_mm256_cmp_pd(edges, largest, _CMP_LE_OQ)) == 0xf;
}

// What is hardly anything, on either side, is 0.

inline __m128 flushTiny(__m128 scaled) {
    const __m128 size = _mm_andnot_ps(_mm_set1_ps(-0.0F), scaled);
    return _mm_andnot_ps(_mm_cmp_ps(size, _mm_set1_ps(kTinyCell<float>), _CMP_LT_OQ), scaled);
}

inline __m256d flushTiny(__m256d scaled) {
    const __m256d size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), scaled);
    return _mm256_andnot_pd(_mm256_cmp_pd(size, _mm256_set1_pd(kTinyCell<double>), _CMP_LT_OQ),
                            scaled);
}

inline __m128 quantiseCorner(const float* corner, const Level<float>& level) {
    const __m128 limit = _mm_set1_ps(static_cast<float>(kCellLimit));
    const __m128 relative = _mm_sub_ps(_mm_load_ps(corner), _mm_loadu_ps(level.origin));
    const __m128 scaled = _mm_mul_ps(relative, _mm_loadu_ps(level.inverseCellSize));
    const __m128 low = _mm_set1_ps(-static_cast<float>(kCellLimit));
    return _mm_floor_ps(flushTiny(_mm_max_ps(_mm_min_ps(scaled, limit), low)));
}

inline __m256d quantiseCorner(const double* corner, const Level<double>& level) {
    const __m256d limit = _mm256_set1_pd(static_cast<double>(kCellLimit));
    const __m256d relative = _mm256_sub_pd(_mm256_load_pd(corner), _mm256_loadu_pd(level.origin));
    const __m256d scaled = _mm256_mul_pd(relative, _mm256_loadu_pd(level.inverseCellSize));
    const __m256d low = _mm256_set1_pd(-static_cast<double>(kCellLimit));
    return _mm256_floor_pd(flushTiny(_mm256_max_pd(_mm256_min_pd(scaled, limit), low)));
}

// Whether each span is 0 or 1 and no cell is clamped.
inline bool spanAtMostTwo(__m128i low, __m128i high) {
    const __m128i span = _mm_sub_epi32(high, low);
    const __m128i isSpan = _mm_cmpeq_epi32(_mm_srli_epi32(span, 1), _mm_setzero_si128());
    const __m128i isAbove = _mm_cmpgt_epi32(low, _mm_set1_epi32(-kCellLimit));
    const __m128i isBelow = _mm_cmplt_epi32(high, _mm_set1_epi32(kCellLimit));
    const __m128i all = _mm_and_si128(isSpan, _mm_and_si128(isAbove, isBelow));
    return _mm_movemask_epi8(all) == 0xffff;
}

inline bool quantiseCorners(const Level<float>& level, const PaddedBox<float>& box,
                            std::int32_t* cell) {
    const __m128i low = _mm_cvttps_epi32(quantiseCorner(box.low, level));
    const __m128i high = _mm_cvttps_epi32(quantiseCorner(box.high, level));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(cell), low);
    return spanAtMostTwo(low, high);
}

inline bool quantiseCorners(const Level<double>& level, const PaddedBox<double>& box,
                            std::int32_t* cell) {
    const __m128i low = _mm256_cvttpd_epi32(quantiseCorner(box.low, level));
    const __m128i high = _mm256_cvttpd_epi32(quantiseCorner(box.high, level));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(cell), low);
    return spanAtMostTwo(low, high);
}

inline std::uint32_t bitCount(std::uint64_t word) {
    return static_cast<std::uint32_t>(_mm_popcnt_u64(word));
}

inline std::uint64_t equalBytes(const std::uint8_t* bytes, std::uint8_t value) {
    std::uint64_t mask = 0;
    for (std::uint32_t k = 0; k < 64; k += 32) {
        const __m256i some = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes + k));
        const __m256i equal = _mm256_cmpeq_epi8(some, _mm256_set1_epi8(static_cast<char>(value)));
        mask |= std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(equal))} << k;
    }
    return mask;
}
