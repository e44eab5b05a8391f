// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX2; compiled with -mavx2.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <immintrin.h>

namespace hashphase::detail {
namespace {

#include <broadphase/simd/kernels_avx.inl>

template <>
struct Pack<double> {
    static constexpr std::uint32_t kWidth = 4;
    using Numbers = __m256d;
    static Numbers load(const double* from) { return _mm256_loadu_pd(from); }
    static void store(double* to, Numbers a) { _mm256_storeu_pd(to, a); }
    static Numbers broadcast(double x) { return _mm256_set1_pd(x); }
    static Numbers minus(Numbers a, Numbers b) { return _mm256_sub_pd(a, b); }
    static Numbers plus(Numbers a, Numbers b) { return _mm256_add_pd(a, b); }
    static Numbers times(Numbers a, Numbers b) { return _mm256_mul_pd(a, b); }
    static Numbers least(Numbers a, Numbers b) { return _mm256_min_pd(a, b); }
    static Numbers greatest(Numbers a, Numbers b) { return _mm256_max_pd(a, b); }
    static Numbers abs(Numbers a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
    static __m256d lessEqual(Numbers a, Numbers b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
    static __m256d bitAnd(__m256d a, __m256d b) { return _mm256_and_pd(a, b); }
    static std::uint32_t bits(__m256d hits) {
        return static_cast<std::uint32_t>(_mm256_movemask_pd(hits));
    }
};

template <class Scalar>
using WidePack = Pack<Scalar>;

/// For each mask of eight the places of its bits, to the front.
struct BitPlaces {
    alignas(8) std::uint8_t of[256][8];
};

constexpr BitPlaces kBitPlaces = [] {
    BitPlaces places{};
    for (std::uint32_t mask = 0; mask < 256; ++mask) {
        std::uint32_t count = 0;
        for (std::uint32_t bit = 0; bit < 8; ++bit) {
            if (((mask >> bit) & 1) != 0) {
                places.of[mask][count++] = static_cast<std::uint8_t>(bit);
            }
        }
    }
    return places;
}();

inline std::uint32_t* writeHits(std::uint64_t word, const std::uint32_t* numbers,
                                std::uint32_t* next) {
    for (std::uint32_t k = 0; k < 64; k += 8) {
        const auto mask = static_cast<std::uint32_t>(word >> k) & 0xff;
        const __m256i some = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers + k));
        const __m256i places = _mm256_cvtepu8_epi32(
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kBitPlaces.of[mask])));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(next),
                            _mm256_permutevar8x32_epi32(some, places));
        next += bitCount(mask);
    }
    return next;
}

#include <broadphase/simd/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx2KernelsFloat;
extern const Kernels<double> kAvx2KernelsDouble;
const Kernels<float> kAvx2KernelsFloat = kKernels<float>;
const Kernels<double> kAvx2KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
