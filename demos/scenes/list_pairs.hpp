// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/pairs.hpp>
#include <demos/scenes/pair_key.hpp>

#include <vector>

namespace hashphase::demos {

/// Adds the pairs, by the indices of their proxies; of an empty grid, these count from 0.
template <class Scalar>
void listPairs(const Pairs<Scalar>& pairs, std::vector<PairKey>& keys) {
    std::vector<ProxyPair> all;
    pairs.collect(all);
    for (const ProxyPair& pair : all) {
        keys.push_back(pairKey(pair.first.index, pair.second.index));
    }
}

}  // namespace hashphase::demos
