// SPDX-License-Identifier: Zlib
#pragma once

// A ray against four boxes at once, erring to the side of a hit: what it lets pass is for the
// region's own key() to decide. After the slab test of Kay and Kajiya, "Ray tracing complex scenes",
// widened as in Ize, "Robust BVH ray traversal". The scalar version is the definition; the vector
// version gives the same bits.

#include <broadphase/aabb.hpp>
#include <broadphase/detail/overlap_kernel.hpp>

#include <array>
#include <cstdint>

namespace hashphase::detail {

/// Four boxes by column: min x, y, z, max x, y, z, in single precision and rounded outward. A lane
/// without a box is inverted infinitely, which nothing meets.
struct alignas(16) BoxBlock {
    std::array<std::array<float, kLanes>, 6> bounds;
    /// Per lane, what stands behind the box: a block, or a slot in the lowest blocks.
    std::array<std::uint32_t, kLanes> below;
};

/// A ray, or a box moved along it, prepared for many boxes: position t in [0, 1] is inside the slab
/// of an axis from (near bound - nearOffset) * inverse to (far bound - farOffset) * farInverse.
struct RayLanes {
    std::array<std::uint32_t, 3> nearColumn{};
    std::array<std::uint32_t, 3> farColumn{};
    std::array<float, 3> nearOffset{};
    std::array<float, 3> farOffset{};
    std::array<float, 3> inverse{};
    std::array<float, 3> farInverse{};  // the least bit longer than `inverse`
};

/// Bit k of the result tells whether the ray may meet box k at some t in [0, last]; enter[k] is then
/// a lower bound of that t.
[[nodiscard]] inline std::uint32_t mayMeetMaskScalar(const BoxBlock& block, const RayLanes& ray,
                                                     float last, float* enter) noexcept {
    std::uint32_t mask = 0;
    for (std::uint32_t k = 0; k < kLanes; ++k) {
        float first = 0;
        float leave = last;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float near =
                (block.bounds[ray.nearColumn[axis]][k] - ray.nearOffset[axis]) * ray.inverse[axis];
            const float far =
                (block.bounds[ray.farColumn[axis]][k] - ray.farOffset[axis]) * ray.farInverse[axis];
            // As the vector instructions do it: a NaN changes nothing.
            first = near > first ? near : first;
            leave = far < leave ? far : leave;
        }
        enter[k] = first;
        mask |= static_cast<std::uint32_t>(first <= leave) << k;
    }
    return mask;
}

#if HASHPHASE_HAS_SSE2

[[nodiscard]] inline std::uint32_t mayMeetMask(const BoxBlock& block, const RayLanes& ray,
                                               float last, float* enter) noexcept {
    __m128 first = _mm_setzero_ps();
    __m128 leave = _mm_set1_ps(last);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const __m128 nearBound = _mm_load_ps(block.bounds[ray.nearColumn[axis]].data());
        const __m128 farBound = _mm_load_ps(block.bounds[ray.farColumn[axis]].data());
        const __m128 near = _mm_mul_ps(_mm_sub_ps(nearBound, _mm_set1_ps(ray.nearOffset[axis])),
                                       _mm_set1_ps(ray.inverse[axis]));
        const __m128 far = _mm_mul_ps(_mm_sub_ps(farBound, _mm_set1_ps(ray.farOffset[axis])),
                                      _mm_set1_ps(ray.farInverse[axis]));
        first = _mm_max_ps(near, first);
        leave = _mm_min_ps(far, leave);
    }
    _mm_storeu_ps(enter, first);
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(first, leave)));
}

#else

[[nodiscard]] inline std::uint32_t mayMeetMask(const BoxBlock& block, const RayLanes& ray,
                                               float last, float* enter) noexcept {
    return mayMeetMaskScalar(block, ray, last, enter);
}

#endif

}  // namespace hashphase::detail
