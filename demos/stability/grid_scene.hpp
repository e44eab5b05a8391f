// SPDX-License-Identifier: Zlib
#pragma once

// Our grid without Bullet, for what Bullet has no question for.

#include <broadphase/pairs.hpp>
#include <demos/compare/reference_pairs.hpp>

#include <span>
#include <vector>

namespace hashphase::demos {

/// A pair by object numbers, which are the indices of proxies that were added to an empty grid, one
/// after another.
[[nodiscard]] inline PairKey keyOf(const ProxyPair& pair) noexcept {
    return pairKey(pair.first.index, pair.second.index);
}

/// What Pairs says of the boxes, sorted.
template <class Scalar>
[[nodiscard]] std::vector<PairKey> gridPairs(std::span<const Aabb<Scalar>> boxes,
                                             const GridConfig& config = {}) {
    Grid<Scalar> grid(config);
    Pairs<Scalar> pairs(grid);
    for (const Aabb<Scalar>& box : boxes) {
        static_cast<void>(grid.add(box));
    }
    std::vector<PairKey> keys;
    for (const ProxyPair& pair : pairs.update([](ProxyId, ProxyId) { return true; }).born) {
        keys.push_back(keyOf(pair));
    }
    return keys;
}

template <class Scalar>
[[nodiscard]] std::vector<PairKey> gridPairs(const std::vector<Aabb<Scalar>>& boxes,
                                             const GridConfig& config = {}) {
    return gridPairs<Scalar>(std::span<const Aabb<Scalar>>(boxes), config);
}

}  // namespace hashphase::demos
