// SPDX-License-Identifier: Zlib
#pragma once

// The pairs of boxes found by sorting along an axis: an oracle for crowds that are too many for
// brute force.

#include <broadphase/pairs.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Numbers of boxes that overlap, found by sorting along x; and how many tests of two boxes that
/// takes.
struct Swept {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::uint64_t tests = 0;

    template <class Scalar>
    explicit Swept(const std::vector<Aabb<Scalar>>& boxes) {
        std::vector<std::uint32_t> order(boxes.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].min()[0] < boxes[b].min()[0];
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Aabb<Scalar>& box = boxes[order[i]];
            for (std::size_t j = i + 1;
                 j < order.size() && boxes[order[j]].min()[0] <= box.max()[0]; ++j) {
                ++tests;
                if (overlaps(box, boxes[order[j]])) {
                    pairs.push_back(std::minmax(order[i], order[j]));
                }
            }
        }
        std::sort(pairs.begin(), pairs.end());
    }
};

/// The pairs are those of the sweep; returns what they cost.
template <class Scalar>
PairCost expectPairsOfSweep(const std::vector<Aabb<Scalar>>& boxes, const GridConfig& config,
                            const Swept& swept) {
    Grid<Scalar> grid(config);
    Pairs<Scalar> pairs(grid);
    for (const Aabb<Scalar>& box : boxes) {
        static_cast<void>(grid.add(box));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const ProxyPair& pair : pairs.update([](ProxyId, ProxyId) { return true; }).born) {
        found.emplace_back(pair.first.index, pair.second.index);
    }
    EXPECT_EQ(differences(found, swept.pairs), "");
    EXPECT_EQ(grid.validate(), "");
    return pairs.lastCost();
}

template <class Scalar>
PairCost expectPairsOfSweep(const std::vector<Aabb<Scalar>>& boxes, const GridConfig& config) {
    return expectPairsOfSweep(boxes, config, Swept(boxes));
}

}  // namespace hashphase::test
