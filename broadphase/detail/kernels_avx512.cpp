// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX-512 (F, VL, BW, DQ); compiled with these. For single
// precision, registers of eight numbers serve the short runs as well as AVX2 does, and those of
// sixteen the long ones.

#include <broadphase/detail/kernel_types.hpp>
#include <broadphase/detail/quantise.hpp>

#include <immintrin.h>

namespace hashphase::detail {
namespace {

#include <broadphase/detail/kernels_avx.inl>

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 8;
    using Numbers = __m512d;
    static Numbers load(const double* from) { return _mm512_loadu_pd(from); }
    static Numbers all(double x) { return _mm512_set1_pd(x); }
    static __mmask8 notAbove(Numbers a, Numbers b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
    static __mmask8 both(__mmask8 a, __mmask8 b) { return a & b; }
    static std::uint32_t bits(__mmask8 hits) { return hits; }
};

template <class Scalar>
struct WidePack : Pack<Scalar> {};

template <>
struct WidePack<float> {
    static constexpr std::uint32_t kWidth = 16;
    using Numbers = __m512;
    static Numbers load(const float* from) { return _mm512_loadu_ps(from); }
    static Numbers all(float x) { return _mm512_set1_ps(x); }
    static __mmask16 notAbove(Numbers a, Numbers b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    static __mmask16 both(__mmask16 a, __mmask16 b) { return a & b; }
    static std::uint32_t bits(__mmask16 hits) { return hits; }
};

#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx512KernelsFloat;
extern const Kernels<double> kAvx512KernelsDouble;
const Kernels<float> kAvx512KernelsFloat = kKernels<float>;
const Kernels<double> kAvx512KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
