// SPDX-License-Identifier: Zlib
#pragma once

// What the ray kernel reads and writes: as kernel_types.hpp, plain arrays and nothing that has
// code.

#include <cstdint>

namespace hashphase::detail {

/// Boxes of a block.
inline constexpr std::uint32_t kBlockWidth = 8;

/// Eight boxes by column: min x, y, z, max x, y, z, in single precision and rounded outward. A lane
/// without a box is inverted infinitely, which nothing meets.
struct alignas(16) TreeNode8 {
    float bounds[6][kBlockWidth];
    /// Per lane, what stands behind the box: a block, or an index in the lowest blocks.
    std::uint32_t children[kBlockWidth];
    std::uint32_t count;  // of lanes with a box, the first ones
};

/// A ray, or a box moved along it, prepared for many boxes: position t in [0, 1] is in the slab of
/// an axis from (bound - offset) * inverse of the near column to (bound - offset) * farInverse of
/// the far one.
struct RayLanes {
    std::uint32_t nearColumn[3];
    std::uint32_t farColumn[3];
    float offset[6];  // by column
    float inverse[3];
    float farInverse[3];  // the least bit longer than `inverse`
};

/// A part of a ray, or of a box moved along it, as a search of cells sees it: position t in [0, last] is in
/// the slab of an axis between (low bound - lowFrom) * inverse and (high bound - highFrom) * inverse.
template <class Scalar>
struct RayPart {
    Scalar lowFrom[3];
    Scalar highFrom[3];
    Scalar inverse[3];
    Scalar last;
    // What it meets overlaps these bounds, min x, y, z, max x, y, z, and lies in these cells.
    Scalar bounds[6];
    std::int32_t lowCell[3];
    std::int32_t highCell[3];
    // An axis on which few of the boxes that are read overlap the bounds, or none.
    static constexpr std::uint32_t kNoSieve = 3;
    std::uint32_t sieve = kNoSieve;
};

/// Where a kernel brings what a ray may meet: take(sink, indices, count) takes that of one block,
/// from near to far, and may make `last` smaller; false ends the search.
struct RaySink {
    float last;  // what is met later is not looked for
    bool (*take)(RaySink& sink, const std::uint32_t* proxyIndices, std::uint32_t count);
    void* owner;
};

}  // namespace hashphase::detail
