// SPDX-License-Identifier: Zlib
#pragma once

// The one place where a coordinate becomes a cell. Every insert and every query goes through
// quantise(); because it is monotone, rounding can put a point into a neighbouring cell but can
// never separate two boxes that touch: a.min <= b.max implies cell(a.min) <= cell(b.max).

#include <broadphase/core/compiler.hpp>

#include <array>
#include <cstdint>

namespace hashphase::detail {

/// Cells are numbered from -kCellLimit to kCellLimit on each axis.
inline constexpr std::int32_t kCellLimit = 1 << 28;

using Cell = std::array<std::int32_t, 3>;

/// So little below a border counts as on it: more than what a processor that flushes denormal numbers
/// makes of (x - origin) * inverseCellSize differs from what another one makes of it, when the three
/// are normal numbers or zero, and the cells no smaller than 1e-30. So threads may differ in this.
template <class Scalar>
inline constexpr Scalar kTinyCell = sizeof(Scalar) == sizeof(float) ? Scalar(0x1p-25)
                                                                    : Scalar(0x1p-54);

/// floor((x - origin) * inverseCellSize), clamped to the cell range in floating point, before the
/// conversion, so that no value is undefined behaviour; NaN gives kCellLimit. The subtraction, the
/// multiplication and the floor are each monotone after rounding. An origin near the population
/// keeps the cells of a far-away world apart.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::int32_t quantise(
    Scalar x, Scalar origin, Scalar inverseCellSize) noexcept {
    constexpr auto limit = static_cast<Scalar>(kCellLimit);
    Scalar scaled = (x - origin) * inverseCellSize;
    scaled = scaled < limit ? scaled : limit;
    scaled = scaled > -limit ? scaled : -limit;
    // Both sides, for compilers make vector instructions of that. The other one's floor is 0 anyway.
    // Without a branch on the sign, which no processor could foresee.
    const auto size = magnitude(scaled);
    scaled = size < kTinyCell<Scalar> ? Scalar(0) : scaled;
    const auto truncated = static_cast<std::int32_t>(scaled);
    return truncated - static_cast<std::int32_t>(static_cast<Scalar>(truncated) > scaled);
}

}  // namespace hashphase::detail
