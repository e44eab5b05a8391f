// SPDX-License-Identifier: Zlib

// The kernels with what every x86-64 processor has.

#include <broadphase/detail/kernel_types.hpp>
#include <broadphase/detail/quantise.hpp>

#include <emmintrin.h>

namespace hashphase::detail {
namespace {

template <class Scalar>
class Lanes;

template <>
class Lanes<float> {
public:
    Lanes(const float* const* columns, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = _mm_set1_ps(columns[axis][number]);
            high_[axis] = _mm_set1_ps(columns[axis + 3][number]);
        }
    }

    [[nodiscard]] std::uint32_t overlapMask(const float* const* columns,
                                            std::uint32_t first) const {
        return four(columns, first) | four(columns, first + 4) << 4;
    }

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const float* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<float>& a, const PaddedBox<float>& b) {
        const __m128 one = _mm_cmple_ps(_mm_load_ps(a.low), _mm_load_ps(b.high));
        const __m128 other = _mm_cmple_ps(_mm_load_ps(b.low), _mm_load_ps(a.high));
        return _mm_movemask_ps(_mm_and_ps(one, other)) != 0xf;
    }

private:
    [[nodiscard]] std::uint32_t four(const float* const* columns, std::uint32_t first) const {
        __m128 hit = _mm_cmple_ps(_mm_loadu_ps(columns[0] + first), high_[0]);
        hit = _mm_and_ps(hit, _mm_cmple_ps(low_[0], _mm_loadu_ps(columns[3] + first)));
        hit = _mm_and_ps(hit, _mm_cmple_ps(_mm_loadu_ps(columns[1] + first), high_[1]));
        hit = _mm_and_ps(hit, _mm_cmple_ps(low_[1], _mm_loadu_ps(columns[4] + first)));
        hit = _mm_and_ps(hit, _mm_cmple_ps(_mm_loadu_ps(columns[2] + first), high_[2]));
        hit = _mm_and_ps(hit, _mm_cmple_ps(low_[2], _mm_loadu_ps(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm_movemask_ps(hit));
    }

    __m128 low_[3];
    __m128 high_[3];
};

template <>
class Lanes<double> {
public:
    Lanes(const double* const* columns, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = _mm_set1_pd(columns[axis][number]);
            high_[axis] = _mm_set1_pd(columns[axis + 3][number]);
        }
    }

    [[nodiscard]] std::uint32_t overlapMask(const double* const* columns,
                                            std::uint32_t first) const {
        return two(columns, first) | two(columns, first + 2) << 2 | two(columns, first + 4) << 4 |
               two(columns, first + 6) << 6;
    }

    static constexpr std::uint32_t kLongWidth = 8;

    [[nodiscard]] std::uint32_t longOverlapMask(const double* const* columns,
                                                std::uint32_t first) const {
        return overlapMask(columns, first);
    }

    static bool isApart(const PaddedBox<double>& a, const PaddedBox<double>& b) {
        __m128d all = _mm_cmple_pd(_mm_load_pd(a.low), _mm_load_pd(b.high));
        all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(b.low), _mm_load_pd(a.high)));
        all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(a.low + 2), _mm_load_pd(b.high + 2)));
        all = _mm_and_pd(all, _mm_cmple_pd(_mm_load_pd(b.low + 2), _mm_load_pd(a.high + 2)));
        return _mm_movemask_pd(all) != 0x3;
    }

private:
    [[nodiscard]] std::uint32_t two(const double* const* columns, std::uint32_t first) const {
        __m128d hit = _mm_cmple_pd(_mm_loadu_pd(columns[0] + first), high_[0]);
        hit = _mm_and_pd(hit, _mm_cmple_pd(low_[0], _mm_loadu_pd(columns[3] + first)));
        hit = _mm_and_pd(hit, _mm_cmple_pd(_mm_loadu_pd(columns[1] + first), high_[1]));
        hit = _mm_and_pd(hit, _mm_cmple_pd(low_[1], _mm_loadu_pd(columns[4] + first)));
        hit = _mm_and_pd(hit, _mm_cmple_pd(_mm_loadu_pd(columns[2] + first), high_[2]));
        hit = _mm_and_pd(hit, _mm_cmple_pd(low_[2], _mm_loadu_pd(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm_movemask_pd(hit));
    }

    __m128d low_[3];
    __m128d high_[3];
};

#include <broadphase/detail/corners_scalar.inl>
#include <broadphase/detail/kernels.inl>

}  // namespace

extern const Kernels<float> kSse2KernelsFloat;
extern const Kernels<double> kSse2KernelsDouble;
const Kernels<float> kSse2KernelsFloat = kKernels<float>;
const Kernels<double> kSse2KernelsDouble = kKernels<double>;

}  // namespace hashphase::detail
