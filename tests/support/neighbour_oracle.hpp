// SPDX-License-Identifier: Zlib
#pragma once

// Which boxes are within a distance of each other, in higher precision than that of the boxes: which surely
// are, and which may be, by rounding.

#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {

/// How far apart the boxes are in a straight line.
template <class Scalar>
[[nodiscard]] long double gapBetween(const Aabb<Scalar>& a, const Aabb<Scalar>& b) {
    std::array<long double, 3> gaps{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto gap = [axis](const Aabb<Scalar>& low, const Aabb<Scalar>& high) {
            // Both at the same infinity are no distance apart.
            return low.max()[axis] == high.min()[axis]
                       ? 0.0L
                       : static_cast<long double>(high.min()[axis]) -
                             static_cast<long double>(low.max()[axis]);
        };
        gaps[static_cast<std::size_t>(axis)] = std::max({0.0L, gap(a, b), gap(b, a)});
    }
    // Squares of shares, so that none is 0 or infinite where long double is but double, as under Valgrind.
    const long double largest = *std::max_element(gaps.begin(), gaps.end());
    if (largest == 0 || std::isinf(largest)) {
        return largest;
    }
    long double squares = 0;
    for (const long double gap : gaps) {
        squares += (gap / largest) * (gap / largest);
    }
    return largest * std::sqrt(squares);
}

/// The pairs found are those of the definition, each once. Boxes with NaN are near nothing.
template <class Scalar>
void expectNeighboursLikeBruteForce(std::span<const ProxyPair> pairs,
                                    std::span<const Placed<Scalar>> proxies, Scalar distance) {
    using Limits = std::numeric_limits<Scalar>;
    const auto reach = static_cast<long double>(distance);
    const auto least = static_cast<long double>(4 * Limits::denorm_min());
    std::vector<ProxyPair> surely;
    std::vector<ProxyPair> perhaps;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t k = i + 1; k < proxies.size(); ++k) {
            const Placed<Scalar>& a = proxies[i];
            const Placed<Scalar>& b = proxies[k];
            if (hasNan(a.box) || hasNan(b.box)) {
                continue;
            }
            const long double apart = gapBetween(a.box, b.box);
            const auto slack = static_cast<long double>(8 * Limits::epsilon()) * apart;
            if (apart == 0 ? reach >= 0 : apart + slack + least <= reach) {
                surely.push_back(makePair(a.id, b.id));
            }
            // The first by itself for boxes infinitely far apart.
            if (reach >= 0 && (apart <= reach || apart - slack - least <= reach)) {
                perhaps.push_back(makePair(a.id, b.id));
            }
        }
    }
    std::vector<ProxyPair> found(pairs.begin(), pairs.end());
    for (std::vector<ProxyPair>* list : {&found, &surely, &perhaps}) {
        std::sort(list->begin(), list->end());
    }
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
    EXPECT_TRUE(std::ranges::includes(found, surely))
        << "all that are near, within " << distance << ": " << differences(found, surely);
    EXPECT_TRUE(std::ranges::includes(perhaps, found))
        << "none that are not, within " << distance << ": " << differences(found, perhaps);
}

}  // namespace hashphase::test
