// SPDX-License-Identifier: Zlib
#pragma once

// Four boxes at once against one: the innermost step of every search for overlaps. Buckets mostly
// hold fewer than four boxes, so a run of them is read without a branch that could be mispredicted.
// The scalar version is the definition; the vector versions give the same bits.

#include <broadphase/aabb.hpp>

#include <array>
#include <cstdint>

#if defined(__SSE2__) && !HASHPHASE_USE_SCALAR
#define HASHPHASE_HAS_SSE2 1
#include <emmintrin.h>
#endif

namespace hashphase::detail {

inline constexpr std::uint32_t kLanes = 4;

/// Columns min x, y, z, max x, y, z of a table, readable kLanes - 1 entries past any entry.
template <class Scalar>
using Columns = std::array<const Scalar*, 6>;

/// Bit k of the result tells whether box number first + k overlaps `box` (closed; NaN never).
template <class Scalar>
[[nodiscard]] inline std::uint32_t overlapMaskScalar(const Columns<Scalar>& columns,
                                                     std::uint32_t first,
                                                     const Aabb<Scalar>& box) noexcept {
    std::uint32_t mask = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) {
        const std::uint32_t i = first + k;
        const auto isHit = static_cast<std::uint32_t>(
            (columns[0][i] <= box.max()[0]) & (box.min()[0] <= columns[3][i]) &
            (columns[1][i] <= box.max()[1]) & (box.min()[1] <= columns[4][i]) &
            (columns[2][i] <= box.max()[2]) & (box.min()[2] <= columns[5][i]));
        mask |= isHit << k;
    }
    return mask;
}

#if HASHPHASE_HAS_SSE2

/// The box to test against, one coordinate a register.
template <class Scalar>
struct BoxLanes;

template <>
struct BoxLanes<float> {
    __m128 low[3];
    __m128 high[3];

    explicit BoxLanes(const Aabb<float>& box) noexcept
        : low{_mm_set1_ps(box.min()[0]), _mm_set1_ps(box.min()[1]), _mm_set1_ps(box.min()[2])},
          high{_mm_set1_ps(box.max()[0]), _mm_set1_ps(box.max()[1]), _mm_set1_ps(box.max()[2])} {}

    [[nodiscard]] std::uint32_t overlapMask(const Columns<float>& columns,
                                            std::uint32_t first) const noexcept {
        __m128 hit = _mm_cmple_ps(_mm_loadu_ps(columns[0] + first), high[0]);
        hit = _mm_and_ps(hit, _mm_cmple_ps(low[0], _mm_loadu_ps(columns[3] + first)));
        hit = _mm_and_ps(hit, _mm_cmple_ps(_mm_loadu_ps(columns[1] + first), high[1]));
        hit = _mm_and_ps(hit, _mm_cmple_ps(low[1], _mm_loadu_ps(columns[4] + first)));
        hit = _mm_and_ps(hit, _mm_cmple_ps(_mm_loadu_ps(columns[2] + first), high[2]));
        hit = _mm_and_ps(hit, _mm_cmple_ps(low[2], _mm_loadu_ps(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm_movemask_ps(hit));
    }
};

template <>
struct BoxLanes<double> {
    __m128d low[3];
    __m128d high[3];

    explicit BoxLanes(const Aabb<double>& box) noexcept
        : low{_mm_set1_pd(box.min()[0]), _mm_set1_pd(box.min()[1]), _mm_set1_pd(box.min()[2])},
          high{_mm_set1_pd(box.max()[0]), _mm_set1_pd(box.max()[1]), _mm_set1_pd(box.max()[2])} {}

    [[nodiscard]] std::uint32_t overlapMask(const Columns<double>& columns,
                                            std::uint32_t first) const noexcept {
        return twoLanes(columns, first) | twoLanes(columns, first + 2) << 2;
    }

private:
    [[nodiscard]] std::uint32_t twoLanes(const Columns<double>& columns,
                                         std::uint32_t first) const noexcept {
        __m128d hit = _mm_cmple_pd(_mm_loadu_pd(columns[0] + first), high[0]);
        hit = _mm_and_pd(hit, _mm_cmple_pd(low[0], _mm_loadu_pd(columns[3] + first)));
        hit = _mm_and_pd(hit, _mm_cmple_pd(_mm_loadu_pd(columns[1] + first), high[1]));
        hit = _mm_and_pd(hit, _mm_cmple_pd(low[1], _mm_loadu_pd(columns[4] + first)));
        hit = _mm_and_pd(hit, _mm_cmple_pd(_mm_loadu_pd(columns[2] + first), high[2]));
        hit = _mm_and_pd(hit, _mm_cmple_pd(low[2], _mm_loadu_pd(columns[5] + first)));
        return static_cast<std::uint32_t>(_mm_movemask_pd(hit));
    }
};

#else

template <class Scalar>
struct BoxLanes {
    Aabb<Scalar> box;

    explicit BoxLanes(const Aabb<Scalar>& b) noexcept : box(b) {}

    [[nodiscard]] std::uint32_t overlapMask(const Columns<Scalar>& columns,
                                            std::uint32_t first) const noexcept {
        return overlapMaskScalar(columns, first, box);
    }
};

#endif

}  // namespace hashphase::detail
