// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX-512 (F, VL, BW, DQ); compiled with these. For single
// precision, registers of eight numbers serve the short runs as well as AVX2 does, and those of
// sixteen the long ones.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <immintrin.h>

namespace hashphase::detail {
namespace {

#include <broadphase/simd/kernels_avx.inl>

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 8;
    using Numbers = __m512d;
    static Numbers load(const double* from) { return _mm512_loadu_pd(from); }
    static void store(double* to, Numbers a) { _mm512_storeu_pd(to, a); }
    static Numbers broadcast(double x) { return _mm512_set1_pd(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm512_sub_pd(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm512_add_pd(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm512_mul_pd(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm512_min_pd(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm512_max_pd(a, b); }
    static Numbers abs(Numbers a) { return _mm512_abs_pd(a); }
    static void compress(std::uint32_t mask, const std::uint32_t* numbers, std::uint32_t* to) {
        const auto lanes = static_cast<__mmask8>(mask);
        const __m256i some = _mm256_maskz_loadu_epi32(lanes, numbers);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_maskz_compress_epi32(lanes, some));
    }
    static __mmask8 lessEqual(Numbers a, Numbers b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
    static __mmask8 bitAnd(__mmask8 a, __mmask8 b) { return a & b; }
    static std::uint32_t bits(__mmask8 hits) { return hits; }
};

template <class Scalar>
struct WidePack : Pack<Scalar> {};

template <>
struct WidePack<float> {
    static constexpr std::uint32_t kWidth = 16;
    using Numbers = __m512;
    static Numbers load(const float* from) { return _mm512_loadu_ps(from); }
    static void store(float* to, Numbers a) { _mm512_storeu_ps(to, a); }
    static Numbers broadcast(float x) { return _mm512_set1_ps(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm512_sub_ps(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm512_add_ps(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm512_mul_ps(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm512_min_ps(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm512_max_ps(a, b); }
    static Numbers abs(Numbers a) { return _mm512_abs_ps(a); }
    static void compress(std::uint32_t mask, const std::uint32_t* numbers, std::uint32_t* to) {
        const auto lanes = static_cast<__mmask16>(mask);
        const __m512i some = _mm512_maskz_loadu_epi32(lanes, numbers);
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(lanes, some));
    }
    static __mmask16 lessEqual(Numbers a, Numbers b) {
        return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
    }
    static __mmask16 bitAnd(__mmask16 a, __mmask16 b) { return a & b; }
    static std::uint32_t bits(__mmask16 hits) { return hits; }
};

// Compressed in a register and stored whole: compressing into memory is slow on some processors.
inline std::uint32_t* writeHits(std::uint64_t word, const std::uint32_t* numbers,
                                std::uint32_t* next) {
    for (std::uint32_t k = 0; k < 64; k += 16) {
        const auto mask = static_cast<__mmask16>(word >> k);
        const __m512i some = _mm512_loadu_si512(numbers + k);
        _mm512_storeu_si512(next, _mm512_maskz_compress_epi32(mask, some));
        next += bitCount(mask);
    }
    return next;
}

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx512KernelsFloat;
extern const Kernels<double> kAvx512KernelsDouble;
const Kernels<float> kAvx512KernelsFloat = kKernels<float>;
const Kernels<double> kAvx512KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
