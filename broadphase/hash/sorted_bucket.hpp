// SPDX-License-Identifier: Zlib
#pragma once

// A bucket in which hundreds share a cell, and where to read in it. Inlined into each of the
// kernels: what stands here may call only what is always inlined, as kernels.inl says.

#include <broadphase/core/compiler.hpp>
#include <broadphase/proxy_groups.hpp>

#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// A bucket with more entries than this is crowded, and may be sorted along an axis.
inline constexpr std::uint32_t kCrowdedBucket = 256;

/// A crowded bucket, or those of its entries that have the same groups: sorted by their min corners along
/// an axis, so that not all have to be read, but for the last ones, which are long. Where groups tell
/// apart, the parts of a bucket follow each other, and there are no entries between them.
template <class Scalar>
struct SortedBucket {
    std::uint32_t bucket;     // counted over all levels
    std::uint32_t first;      // entry
    std::uint32_t firstLong;  // entry from which on they are long
    std::uint32_t last;       // one past
    std::uint32_t axis;
    Scalar reach;  // none of the others is longer along the axis
    ProxyGroups groups;
    bool haveSameGroups;
};

// Of its entries first to last, of which none is long, only some can overlap a box that extends from
// `low` to `high` along the axis. Erased entries may have a key of NaN, and a bound may be NaN: there, as
// with every rounding, too many entries are left rather than too few.

/// The first of them, or one before it.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::uint32_t firstNear(
    const SortedBucket<Scalar>& sorted, const Scalar* keys, std::uint32_t first, std::uint32_t last,
    Scalar low) noexcept {
    // Rounded, the difference is still no more than the min corner of any box that reaches `low`: that
    // is a number, and rounding is monotone.
    const Scalar bound = low - sorted.reach;
    while (first < last) {
        const std::uint32_t middle = first + (last - first) / 2;
        if (keys[middle] < bound) {
            first = middle + 1;
        } else {
            last = middle;
        }
    }
    return first;
}

/// One past the last of them, or one behind it; before firstNear() when there is none.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::uint32_t endOfNear(const Scalar* keys,
                                                                      std::uint32_t first,
                                                                      std::uint32_t last,
                                                                      Scalar high) noexcept {
    while (first < last) {
        const std::uint32_t middle = first + (last - first) / 2;
        if (high < keys[middle]) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    return first;
}

}  // namespace hashphase::detail
