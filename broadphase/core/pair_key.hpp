// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase::detail {

/// Two proxy indices, the smaller one on top, so that pairs sort by their indices.
using PairKey = std::uint64_t;

[[nodiscard]] constexpr PairKey pairKey(std::uint32_t a, std::uint32_t b) noexcept {
    return a < b ? PairKey{a} << 32 | b : PairKey{b} << 32 | a;
}
[[nodiscard]] constexpr std::uint32_t firstIndex(PairKey key) noexcept {
    return static_cast<std::uint32_t>(key >> 32);
}
[[nodiscard]] constexpr std::uint32_t secondIndex(PairKey key) noexcept {
    return static_cast<std::uint32_t>(key);
}

}  // namespace hashphase::detail
