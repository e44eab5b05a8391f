// SPDX-License-Identifier: Zlib
#pragma once

// Pairs that are ignored: candidates that are refused without a question.

#include <broadphase/pairs/immediate.inl>

#include <broadphase/core/on_failure.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::detail {

[[nodiscard]] inline ProxyPair inOrder(const ProxyPair& pair) noexcept {
    return pair.first < pair.second ? pair : ProxyPair{pair.second, pair.first};
}

template <class Scalar>
[[nodiscard]] bool isIgnored(const PairState<Scalar>& pairs, const ProxyPair& pair) noexcept {
    return pairs.known.isIgnored(inOrder(pair)) && pairs.areAlive(pair);
}

template <class Scalar>
void collectIgnored(const PairState<Scalar>& pairs, std::vector<ProxyPair>& all) {
    const auto begin = static_cast<std::ptrdiff_t>(all.size());
    if (pairs.known.ignored == nullptr) {
        return;
    }
    std::ranges::copy_if(pairs.known.ignored->pairs(), std::back_inserter(all),
                         [&](const ProxyPair& pair) { return pairs.areAlive(pair); });
    std::sort(all.begin() + begin, all.end());
}

template <class Scalar>
[[nodiscard]] PairChanges ignore(PairState<Scalar>& pairs, std::span<const ProxyPair> some) {
    beginRefilter(pairs);
    if (pairs.known.ignored == nullptr) {
        pairs.known.ignored = std::make_unique<IgnoredPairs>();
    }
    IgnoredPairs& ignored = *pairs.known.ignored;
    std::vector<ProxyPair> added;
    added.reserve(some.size());
    ignored.reserve(some.size(), [&](const ProxyPair& pair) { return !pairs.areAlive(pair); });
    const OnFailure eraseAdded([&] {
        for (const ProxyPair& pair : added) {
            ignored.erase(pair);
        }
    });
    for (const ProxyPair& pair : some) {
        if (pair.first == pair.second || !pairs.areAlive(pair) || isIgnored(pairs, pair)) {
            continue;
        }
        added.push_back(inOrder(pair));
        ignored.insert(added.back());
        if (isPair(pairs, pair)) {
            listAgain(pairs, pairKey(pair.first.index, pair.second.index));
        }
    }
    return endCall(pairs, acceptAllPairs);
}

template <class Scalar>
[[nodiscard]] PairChanges stopIgnoring(PairState<Scalar>& pairs, std::span<const ProxyPair> some,
                                       PairFilter filter) {
    beginRefilter(pairs);
    std::vector<ProxyPair> erased;
    erased.reserve(some.size());
    const OnFailure insertErased([&] {
        for (const ProxyPair& pair : erased) {
            pairs.known.ignored->insert(pair);
        }
    });
    for (const ProxyPair& pair : some) {
        if (!isIgnored(pairs, pair)) {
            continue;
        }
        erased.push_back(inOrder(pair));
        pairs.known.ignored->erase(erased.back());
        const PairKey key = pairKey(pair.first.index, pair.second.index);
        if (pairs.isKnown(key)) {
            listAgain(pairs, key);
        } else {
            listIfNew(pairs, key);
        }
    }
    return endCall(pairs, filter);
}

}  // namespace hashphase::detail
