// SPDX-License-Identifier: Zlib

// The kernels for processors with AVX2; compiled with -mavx2.

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

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const float* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
        const __m128 one = _mm_cmp_ps(_mm_load_ps(a.low), _mm_load_ps(b.high), _CMP_LE_OQ);
        const __m128 other = _mm_cmp_ps(_mm_load_ps(b.low), _mm_load_ps(a.high), _CMP_LE_OQ);
        return _mm_movemask_ps(_mm_and_ps(one, other)) != 0xf;
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
            low_[axis] = _mm256_broadcast_sd(columns[axis] + number);
            high_[axis] = _mm256_broadcast_sd(columns[axis + 3] + number);
        }
    }

    [[nodiscard]] std::uint32_t overlapMask(const double* const* columns,
                                            std::uint32_t first) const {
        return four(columns, first) | four(columns, first + 4) << 4;
    }

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const double* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
        const __m256d one = notAbove(_mm256_load_pd(a.low), _mm256_load_pd(b.high));
        const __m256d other = notAbove(_mm256_load_pd(b.low), _mm256_load_pd(a.high));
        return _mm256_movemask_pd(_mm256_and_pd(one, other)) != 0xf;
    }

private:
    static __m256d notAbove(__m256d a, __m256d b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }

    [[nodiscard]] std::uint32_t four(const double* const* columns, std::uint32_t first) const {
        __m256d hit = notAbove(_mm256_loadu_pd(columns[0] + first), high_[0]);
        hit = _mm256_and_pd(hit, notAbove(low_[0], _mm256_loadu_pd(columns[3] + first)));
        hit = _mm256_and_pd(hit, notAbove(_mm256_loadu_pd(columns[1] + first), high_[1]));
        hit = _mm256_and_pd(hit, notAbove(low_[1], _mm256_loadu_pd(columns[4] + first)));
        hit = _mm256_and_pd(hit, notAbove(_mm256_loadu_pd(columns[2] + first), high_[2]));
        hit = _mm256_and_pd(hit, notAbove(low_[2], _mm256_loadu_pd(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm256_movemask_pd(hit));
    }

    __m256d low_[3];
    __m256d high_[3];
};

#include <broadphase/detail/corners_avx.inl>
#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kAvx2KernelsFloat;
extern const Kernels<double> kAvx2KernelsDouble;
const Kernels<float> kAvx2KernelsFloat = kKernels<float>;
const Kernels<double> kAvx2KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
