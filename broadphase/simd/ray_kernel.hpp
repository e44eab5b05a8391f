// SPDX-License-Identifier: Zlib
#pragma once

// A ray against four boxes at once, erring to the side of a hit: what it lets pass is for the
// region's own key() to decide. After the slab test of Kay and Kajiya, "Ray tracing complex scenes",
// widened as in Ize, "Robust BVH ray traversal". The scalar version is the definition; the vector
// version gives the same bits.

#include <broadphase/export.hpp>

#include <array>
#include <cstdint>

#if defined(__SSE2__) && !HASHPHASE_USE_SCALAR
#define HASHPHASE_HAS_SSE2
#include <emmintrin.h>
#endif

namespace hashphase::detail {

/// Boxes of a block.
inline constexpr std::uint32_t kBlockWidth = 8;

/// Eight boxes by column: min x, y, z, max x, y, z, in single precision and rounded outward. A lane
/// without a box is inverted infinitely, which nothing meets.
struct alignas(16) BoxBlock {
    std::array<std::array<float, kBlockWidth>, 6> bounds;
    /// Per lane, what stands behind the box: a block, or a slot in the lowest blocks.
    std::array<std::uint32_t, kBlockWidth> below;
    std::uint32_t count;  // of lanes with a box, the first ones
};

/// A ray, or a box moved along it, prepared for many boxes: position t in [0, 1] is in the slab of
/// an axis from (bound - offset) * inverse of the near column to (bound - offset) * farInverse of
/// the far one.
struct RayLanes {
    std::array<std::uint32_t, 3> nearColumn;
    std::array<std::uint32_t, 3> farColumn;
    std::array<float, 6> offset;  // by column
    std::array<float, 3> inverse;
    std::array<float, 3> farInverse;  // the least bit longer than `inverse`
};

/// Bit k of the result tells whether the ray may meet box k at some t in [0, last]; enter[k] is then
/// a lower bound of that t.
[[nodiscard]] inline std::uint32_t mayMeetMaskScalar(const BoxBlock& block, const RayLanes& ray,
                                                     float last, float* enter) noexcept {
    std::uint32_t mask = 0;
    for (std::uint32_t k = 0; k < kBlockWidth; ++k) {
        float first = 0;
        float exit = last;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float slabEnter =
                (block.bounds[ray.nearColumn[axis]][k] - ray.offset[ray.nearColumn[axis]]) *
                ray.inverse[axis];
            const float slabExit =
                (block.bounds[ray.farColumn[axis]][k] - ray.offset[ray.farColumn[axis]]) *
                ray.farInverse[axis];
            // As the vector instructions do it: a NaN changes nothing.
            first = slabEnter > first ? slabEnter : first;
            exit = slabExit < exit ? slabExit : exit;
        }
        enter[k] = first;
        mask |= static_cast<std::uint32_t>(first <= exit) << k;
    }
    return mask;
}

#ifdef HASHPHASE_HAS_SSE2

[[nodiscard]] inline std::uint32_t mayMeetMask(const BoxBlock& block, const RayLanes& ray,
                                               float last, float* enter) noexcept {
    __m128 first[2] = {_mm_setzero_ps(), _mm_setzero_ps()};
    __m128 exit[2] = {_mm_set1_ps(last), _mm_set1_ps(last)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const __m128 nearOffset = _mm_set1_ps(ray.offset[ray.nearColumn[axis]]);
        const __m128 farOffset = _mm_set1_ps(ray.offset[ray.farColumn[axis]]);
        const __m128 inverse = _mm_set1_ps(ray.inverse[axis]);
        const __m128 farInverse = _mm_set1_ps(ray.farInverse[axis]);
        const float* nearBounds = block.bounds[ray.nearColumn[axis]].data();
        const float* farBounds = block.bounds[ray.farColumn[axis]].data();
        for (std::size_t half = 0; half < 2; ++half) {
            const __m128 slabEnter =
                _mm_mul_ps(_mm_sub_ps(_mm_load_ps(nearBounds + 4 * half), nearOffset), inverse);
            const __m128 slabExit =
                _mm_mul_ps(_mm_sub_ps(_mm_load_ps(farBounds + 4 * half), farOffset), farInverse);
            first[half] = _mm_max_ps(slabEnter, first[half]);
            exit[half] = _mm_min_ps(slabExit, exit[half]);
        }
    }
    _mm_storeu_ps(enter, first[0]);
    _mm_storeu_ps(enter + 4, first[1]);
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(first[0], exit[0]))) |
           static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(first[1], exit[1]))) << 4;
}

#else

[[nodiscard]] inline std::uint32_t mayMeetMask(const BoxBlock& block, const RayLanes& ray,
                                               float last, float* enter) noexcept {
    return mayMeetMaskScalar(block, ray, last, enter);
}

#endif

}  // namespace hashphase::detail
