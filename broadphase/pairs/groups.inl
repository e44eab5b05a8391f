// SPDX-License-Identifier: Zlib
#pragma once

// What groups do to pairs, and to what is known of them, when they have been set.

#include <broadphase/pairs/watched.inl>

namespace hashphase::detail {

// Pairs whose groups have been set, and do not let them pair any more, are kept as long as they overlap.
// Those that may pair again are watched as the others are.
template <class Scalar>
void findKept(PairState<Scalar>& pairs) {
    for (const PairKey key : pairs.known.kept.keys()) {
        pairs.endIfSeparated(key);
        if (pairs.mayPairNow(key)) {
            pairs.call.notKept.push_back(key);
        }
    }
    if (!pairs.proxies.areRegrouped) {
        return;
    }
    forEachWatched(pairs, [&](PairKey key) { pairs.keepIfPair(key); });
    for (const PairKey key : pairs.known.immediate.keys()) {
        pairs.keepIfPair(key);
    }
}

// Lists, to be asked about, what overlapped at the last update, but could not pair, and may now.
template <class Scalar>
void listRegrouped(PairState<Scalar>& pairs) {
    const auto listIfUnknown = [&](std::uint32_t a, std::uint32_t b) {
        const PairKey key = pairKey(a, b);
        if (pairs.store.overlappedAtUpdate(a, b) && !pairs.wasCandidate(key)) {
            pairs.listToAsk(key);
        }
    };
    const Table<Scalar>& table = pairs.tables.mobile;
    for (const auto [a, b] : pairs.watched.amongMobile.pairs()) {
        listIfUnknown(table.proxyIndex(a), table.proxyIndex(b));
    }
    for (const auto [entry, proxyIndex] : pairs.watched.toResting.pairs()) {
        listIfUnknown(table.proxyIndex(entry), proxyIndex);
    }
}

}  // namespace hashphase::detail
