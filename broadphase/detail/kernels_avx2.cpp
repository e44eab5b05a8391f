// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX2; compiled with -mavx2.

#include <broadphase/detail/kernel_types.hpp>
#include <broadphase/detail/quantise.hpp>

#include <immintrin.h>

namespace hashphase::detail {
namespace {

#include <broadphase/detail/kernels_avx.inl>

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 4;
    using Numbers = __m256d;
    static Numbers load(const double* from) { return _mm256_loadu_pd(from); }
    static Numbers all(double x) { return _mm256_set1_pd(x); }
    static Numbers plus(Numbers a, Numbers b) { return _mm256_add_pd(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm256_mul_pd(a, b); }
    static Numbers magnitude(Numbers a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
    static __m256d notAbove(Numbers a, Numbers b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
    static __m256d both(__m256d a, __m256d b) { return _mm256_and_pd(a, b); }
    static std::uint32_t bits(__m256d hits) {
        return static_cast<std::uint32_t>(_mm256_movemask_pd(hits));
    }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx2KernelsFloat;
extern const Kernels<double> kAvx2KernelsDouble;
const Kernels<float> kAvx2KernelsFloat = kKernels<float>;
const Kernels<double> kAvx2KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
