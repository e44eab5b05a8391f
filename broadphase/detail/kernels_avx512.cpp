// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX-512 (F, VL, BW, DQ); compiled with these. A comparison under
// the mask of the comparisons before it is all that a box costs.

#include <broadphase/detail/kernel_types.hpp>
#include <broadphase/detail/quantise.hpp>

#include <immintrin.h>

namespace hashphase::detail {
namespace {

template <class Scalar>
class Lanes;

template <>
class Lanes<float> {
public:
    Lanes(const float* const* columns, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = _mm256_broadcast_ss(columns[axis] + number);
            high_[axis] = _mm256_broadcast_ss(columns[axis + 3] + number);
        }
    }

    [[nodiscard]] std::uint32_t overlapMask(const float* const* columns,
                                            std::uint32_t first) const {
        __m256 hit = notAbove(_mm256_loadu_ps(columns[0] + first), high_[0]);
        hit = _mm256_and_ps(hit, notAbove(low_[0], _mm256_loadu_ps(columns[3] + first)));
        hit = _mm256_and_ps(hit, notAbove(_mm256_loadu_ps(columns[1] + first), high_[1]));
        hit = _mm256_and_ps(hit, notAbove(low_[1], _mm256_loadu_ps(columns[4] + first)));
        hit = _mm256_and_ps(hit, notAbove(_mm256_loadu_ps(columns[2] + first), high_[2]));
        hit = _mm256_and_ps(hit, notAbove(low_[2], _mm256_loadu_ps(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm256_movemask_ps(hit));
    }

    static constexpr std::uint32_t kLongWidth = 16;

    [[nodiscard]] std::uint32_t longOverlapMask(const float* const* columns,
                                                std::uint32_t first) const {
        __mmask16 hit = 0xffff;
        for (int axis = 0; axis < 3; ++axis) {
            const __m512 low = _mm512_set1_ps(_mm256_cvtss_f32(low_[axis]));
            const __m512 high = _mm512_set1_ps(_mm256_cvtss_f32(high_[axis]));
            hit = _mm512_mask_cmp_ps_mask(hit, _mm512_loadu_ps(columns[axis] + first), high,
                                          _CMP_LE_OQ);
            hit = _mm512_mask_cmp_ps_mask(hit, low, _mm512_loadu_ps(columns[axis + 3] + first),
                                          _CMP_LE_OQ);
        }
        return hit;
    }

    static bool isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
        const __mmask8 one = _mm_cmp_ps_mask(_mm_load_ps(a.low), _mm_load_ps(b.high), _CMP_LE_OQ);
        return _mm_mask_cmp_ps_mask(one, _mm_load_ps(b.low), _mm_load_ps(a.high), _CMP_LE_OQ) !=
               0xf;
    }

private:
    static __m256 notAbove(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }

    __m256 low_[3];
    __m256 high_[3];
};

template <>
class Lanes<double> {
public:
    Lanes(const double* const* columns, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = _mm512_set1_pd(columns[axis][number]);
            high_[axis] = _mm512_set1_pd(columns[axis + 3][number]);
        }
    }

    [[nodiscard]] std::uint32_t overlapMask(const double* const* columns,
                                            std::uint32_t first) const {
        __mmask8 hit = 0xff;
        for (int axis = 0; axis < 3; ++axis) {
            hit = _mm512_mask_cmp_pd_mask(hit, _mm512_loadu_pd(columns[axis] + first), high_[axis],
                                          _CMP_LE_OQ);
            hit = _mm512_mask_cmp_pd_mask(hit, low_[axis],
                                          _mm512_loadu_pd(columns[axis + 3] + first), _CMP_LE_OQ);
        }
        return hit;
    }

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const double* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
        const __mmask8 one =
            _mm256_cmp_pd_mask(_mm256_load_pd(a.low), _mm256_load_pd(b.high), _CMP_LE_OQ);
        return _mm256_mask_cmp_pd_mask(one, _mm256_load_pd(b.low), _mm256_load_pd(a.high),
                                       _CMP_LE_OQ) != 0xf;
    }

private:
    __m512d low_[3];
    __m512d high_[3];
};

#include <broadphase/detail/corners_avx.inl>
#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx512KernelsFloat;
extern const Kernels<double> kAvx512KernelsDouble;
const Kernels<float> kAvx512KernelsFloat = kKernels<float>;
const Kernels<double> kAvx512KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
