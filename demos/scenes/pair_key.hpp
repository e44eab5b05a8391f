// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase::demos {

/// An unordered pair of object numbers; keys sort by the smaller number, then by the larger.
using PairKey = std::uint64_t;

[[nodiscard]] constexpr PairKey pairKey(std::uint32_t a, std::uint32_t b) noexcept {
    return a < b ? PairKey{a} << 32 | b : PairKey{b} << 32 | a;
}
[[nodiscard]] constexpr std::uint32_t firstOf(PairKey key) noexcept {
    return static_cast<std::uint32_t>(key >> 32);
}
[[nodiscard]] constexpr std::uint32_t secondOf(PairKey key) noexcept {
    return static_cast<std::uint32_t>(key);
}

}  // namespace hashphase::demos
