// SPDX-License-Identifier: Zlib
#pragma once

// The exact pair set by the plainest means, as the judge of every broadphase. It shares no code with
// the library.
//
// Overlap  closed boxes: touching counts; NaN overlaps nothing.
// Order    pairs come sorted by key, each once.

#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/pair_key.hpp>

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

namespace hashphase::demos {

enum class ReferenceMethod { kSweep, kBrute };

/// Replaces `pairs` by the overlapping pairs that the filters allow. `filters` is empty (all allowed)
/// or as long as `boxes`. Cost: kSweep sorts along one axis and tests what overlaps there; kBrute
/// tests every pair.
void findExactPairs(ReferenceMethod method, std::span<const Aabb<float>> boxes,
                    std::span<const CollisionFilter> filters, std::vector<PairKey>& pairs);

/// How many of the items another list does not have; of an item that comes twice, it must have two. Both
/// sorted.
template <class Item>
[[nodiscard]] std::size_t countMissing(const std::vector<Item>& items,
                                       const std::vector<Item>& other) {
    std::vector<Item> missing;
    std::set_difference(items.begin(), items.end(), other.begin(), other.end(),
                        std::back_inserter(missing));
    return missing.size();
}

}  // namespace hashphase::demos
