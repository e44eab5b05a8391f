// SPDX-License-Identifier: Zlib

// The kernels with what every x86-64 processor has.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <emmintrin.h>

namespace hashphase::detail {
namespace {

template <class Scalar>
struct Pack;

template <>
struct Pack<float> {
    static constexpr std::uint32_t kWidth = 4;
    using Numbers = __m128;
    static Numbers load(const float* from) { return _mm_loadu_ps(from); }
    static void store(float* to, Numbers a) { _mm_storeu_ps(to, a); }
    static Numbers broadcast(float x) { return _mm_set1_ps(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm_sub_ps(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm_add_ps(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm_mul_ps(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm_min_ps(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm_max_ps(a, b); }
    static Numbers abs(Numbers a) { return _mm_andnot_ps(_mm_set1_ps(-0.0F), a); }
    static __m128 lessEqual(Numbers a, Numbers b) { return _mm_cmple_ps(a, b); }
    static __m128 bitAnd(__m128 a, __m128 b) { return _mm_and_ps(a, b); }
    static std::uint32_t bits(__m128 hits) {
        return static_cast<std::uint32_t>(_mm_movemask_ps(hits));
    }
};

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 2;
    using Numbers = __m128d;
    static Numbers load(const double* from) { return _mm_loadu_pd(from); }
    static void store(double* to, Numbers a) { _mm_storeu_pd(to, a); }
    static Numbers broadcast(double x) { return _mm_set1_pd(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm_sub_pd(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm_add_pd(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm_mul_pd(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm_min_pd(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm_max_pd(a, b); }
    static Numbers abs(Numbers a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
    static __m128d lessEqual(Numbers a, Numbers b) { return _mm_cmple_pd(a, b); }
    static __m128d bitAnd(__m128d a, __m128d b) { return _mm_and_pd(a, b); }
    static std::uint32_t bits(__m128d hits) {
        return static_cast<std::uint32_t>(_mm_movemask_pd(hits));
    }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

inline std::uint32_t isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
    const __m128 one = _mm_cmple_ps(_mm_load_ps(a.low), _mm_load_ps(b.high));
    const __m128 other = _mm_cmple_ps(_mm_load_ps(b.low), _mm_load_ps(a.high));
    return _mm_movemask_ps(_mm_and_ps(one, other)) != 0xf;
}

inline std::uint32_t isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
    __m128d all = _mm_cmple_pd(_mm_load_pd(a.low), _mm_load_pd(b.high));
    all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(b.low), _mm_load_pd(a.high)));
    all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(a.low + 2), _mm_load_pd(b.high + 2)));
    all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(b.low + 2), _mm_load_pd(a.high + 2)));
    return _mm_movemask_pd(all) != 0x3;
}

inline void padCorners(const float* corners, PaddedBox<float>& box) {
    const __m128i low = _mm_castps_si128(_mm_loadu_ps(corners));
    const __m128i high = _mm_castps_si128(_mm_loadu_ps(corners + 2));
    _mm_store_ps(box.low, _mm_castsi128_ps(_mm_srli_si128(_mm_slli_si128(low, 4), 4)));
    _mm_store_ps(box.high, _mm_castsi128_ps(_mm_srli_si128(high, 4)));
}

inline void padCorners(const double* corners, PaddedBox<double>& box) {
    _mm_store_pd(box.low, _mm_loadu_pd(corners));
    _mm_store_pd(box.low + 2, _mm_load_sd(corners + 2));
    _mm_store_pd(box.high, _mm_loadu_pd(corners + 3));
    _mm_store_pd(box.high + 2, _mm_load_sd(corners + 5));
}

inline std::uint64_t equalBytes(const std::uint8_t* bytes, std::uint8_t value) {
    std::uint64_t mask = 0;
    for (std::uint32_t k = 0; k < 64; k += 16) {
        const __m128i some = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + k));
        const __m128i equal = _mm_cmpeq_epi8(some, _mm_set1_epi8(static_cast<char>(value)));
        mask |= std::uint64_t{static_cast<std::uint32_t>(_mm_movemask_epi8(equal))} << k;
    }
    return mask;
}

#include <broadphase/simd/bit_count_scalar.inl>
#include <broadphase/simd/corners_scalar.inl>
#include <broadphase/simd/write_hits_scalar.inl>

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kSse2KernelsFloat;
extern const Kernels<double> kSse2KernelsDouble;
const Kernels<float> kSse2KernelsFloat = kKernels<float>;
const Kernels<double> kSse2KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
