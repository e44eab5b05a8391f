// SPDX-License-Identifier: Zlib
#pragma once

// The exact pair set by the plainest means, as the judge of every broadphase. It shares no code with
// the library.
//
// Overlap  closed boxes: touching counts; NaN overlaps nothing.
// Order    pairs come sorted by key, each once.

#include <demos/scenes/box_scene.hpp>

#include <cstdint>
#include <span>
#include <vector>

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

enum class ReferenceMethod { kSweep, kBrute };

/// Replaces `pairs` by the overlapping pairs that the filters allow. `filters` is empty (all allowed)
/// or as long as `boxes`. Cost: kSweep sorts along one axis and tests what overlaps there; kBrute
/// tests every pair.
void findExactPairs(ReferenceMethod method, std::span<const Aabb<float>> boxes,
                    std::span<const CollisionFilter> filters, std::vector<PairKey>& pairs);

}  // namespace hashphase::demos
