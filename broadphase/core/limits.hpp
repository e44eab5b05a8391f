// SPDX-License-Identifier: Zlib
#pragma once

// How many of anything there may be. Whatever grows is measured before it does, so that no number
// wraps around: beyond its limit it throws std::length_error, and is as it was.

#include <broadphase/core/raise.hpp>

#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// Proxies of a grid, and so entries of a table: a level has up to 12 buckets a box, of which the
/// numbers, over all levels, have 32 bits.
inline constexpr std::size_t kMostProxies = std::size_t{1} << 28;

/// An index of this generation, which is even as all that are free, has used up its ids: it stays free,
/// or an id would come to name something else.
inline constexpr std::uint32_t kLastGeneration = ~std::uint32_t{1};

/// Throws std::length_error with the sentence when `count` is more than `most`.
inline void checkCount(std::size_t count, std::size_t most, const char* sentence) {
    if (count > most) [[unlikely]] {
        raiseLengthError(sentence);
    }
}

}  // namespace hashphase::detail
