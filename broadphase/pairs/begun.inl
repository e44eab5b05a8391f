// SPDX-License-Identifier: Zlib
#pragma once

// Which candidates have come to overlap.

#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/groups.inl>
#include <broadphase/pairs/remembered.inl>
#include <broadphase/pairs/settled.inl>
#include <broadphase/pairs/swept.inl>
#include <broadphase/pairs/watched.inl>

#include <algorithm>
#include <span>
#include <utility>

namespace hashphase::detail {

// Where some that rest have moved within their slack, each mobile one is looked for among them.
template <class Scalar>
[[nodiscard]] bool isRestAstir(const PairState<Scalar>& pairs) noexcept {
    return pairs.proxies.settledChanged > 0;
}

// Candidates of a mobile one that has not changed and a resting one that has not are not looked for again.
template <class Scalar>
void carryToRest(PairState<Scalar>& pairs, bool someSettled) {
    const Population<Scalar>& proxies = pairs.proxies;
    WatchedPairs& watched = pairs.watched;
    watched.carried.clear();
    if (pairs.tables.resting.size() == 0 || isRestAstir(pairs)) {
        return;
    }
    const auto order = pairs.tables.mobile.order();
    std::vector<std::uint32_t>& entryOf = pairs.scratch.entryOf;
    entryOf.resize(proxies.mobile.size());
    for (std::uint32_t entry = 0; entry < order.size(); ++entry) {
        entryOf[order[entry]] = entry;
    }
    const auto carryIfKept = [&](std::uint32_t place, std::uint32_t resting) {
        const std::uint32_t mobile = proxies.mobile[place];
        const bool isKept = proxies.records[resting].residency == Residency::resting &&
                            proxies.records[mobile].residency == Residency::mobile &&
                            !proxies.changedNow(mobile);
        if (isKept) {
            watched.carried.push({entryOf[place], resting});
        }
    };
    for (const auto [place, proxyIndex] : watched.toResting.pairs()) {
        carryIfKept(place, proxyIndex);
    }
    if (someSettled) {
        for (const auto [a, b] : watched.amongMobile.pairs()) {
            carryIfKept(a, proxies.mobile[b]);
            carryIfKept(b, proxies.mobile[a]);
        }
    }
}

template <class Scalar>
void joinMobile(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Table<Scalar>& table = pairs.tables.mobile;
    PairList& found = pairs.watched.amongMobile;
    joinAllowed(pairs, table, pairs.store.frame.mobileKinds, found, parallelFor);
    listKeys(selectApart<Scalar>(pairs.scratch, found.pairs(), table.order().data(),
                                 pairs.store.frame.before.data(), parallelFor),
             table.proxyIndices().data(), pairs.call.asked, parallelFor);
}

// Selects all that overlap and may pair: entries of the mobile table, of what is searched, and of the resting
// one. The few look for the many.
template <class Scalar>
void selectAgainstResting(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const Table<Scalar>& resting = pairs.tables.resting;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    const bool isAstir = isRestAstir(pairs);
    const GroupKinds::Set kinds =
        isAstir ? pairs.store.frame.mobileKinds : pairs.store.frame.changedKinds;
    const auto isSearched = [&](std::uint32_t proxyIndex) {
        return isAstir || proxies.changedNow(proxyIndex);
    };
    constexpr std::size_t kFew = 4;
    if (kFew * resting.size() < mobile.size()) {
        queryAllowed(pairs, resting.columns(), resting.proxyIndices(), pairs.tables.restingKinds,
                     mobile, pairs.store.frame.mobileKinds, scratch.selected, parallelFor);
        takeOut(scratch.selected,
                [&](const IndexPair& pair) { return !isSearched(mobile.proxyIndex(pair.b)); });
        for (IndexPair& pair : scratch.selected.all()) {
            std::swap(pair.a, pair.b);
        }
        return;
    }
    listSearched(pairs, mobile, isSearched);
    queryAllowed(pairs, scratch.bounds.columns(), std::span(scratch.searchedIndices), kinds,
                 resting, pairs.tables.restingKinds, scratch.selected, parallelFor);
    for (IndexPair& pair : scratch.selected.all()) {
        pair.a = scratch.searchedEntries[pair.a];
    }
}

// What may have met a resting proxy.
template <class Scalar>
void findAgainstResting(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const Table<Scalar>& resting = pairs.tables.resting;
    WatchedPairs& watched = pairs.watched;
    watched.toResting.swap(watched.carried);
    if (resting.size() == 0) {
        return;
    }
    selectAgainstResting(pairs, parallelFor);
    const bool isShifted = !pairs.proxies.boxesAtUpdate.empty();
    for (const auto [entry, restingEntry] : pairs.scratch.selected.pairs()) {
        const std::uint32_t proxyIndex = resting.proxyIndex(restingEntry);
        watched.toResting.push({entry, proxyIndex});
        // Not by their indices: these boxes are at hand.
        const PaddedBox<Scalar>& before = pairs.store.frame.before[mobile.order()[entry]];
        const Aabb<Scalar> other = isShifted || pairs.proxies.changedNow(proxyIndex)
                                       ? pairs.store.boxAtUpdate(proxyIndex)
                                       : resting.box(restingEntry);
        if (!overlaps(unpadded(before), other)) {
            pairs.listToAsk(pairKey(mobile.proxyIndex(entry), proxyIndex));
        }
    }
}

// A candidate begins when its boxes overlap now and did not at the last update. Returns false where the
// pairs had better be remembered: then it has changed nothing that is of use.
template <class Scalar>
[[nodiscard]] bool findBegun(PairState<Scalar>& pairs, bool someSettled, PairFilter filter,
                             ParallelFor parallelFor) {
    if (pairs.known.arePairs()) {
        findBegunOfPairs(pairs, filter, parallelFor);
        return true;
    }
    if (doesRefuseMost(pairs, filter)) {
        return false;
    }
    carryToRest(pairs, someSettled);
    if (pairs.watched.settled != nullptr) {
        const std::vector<PairKey>& begun = pairs.watched.settled->begun;
        std::for_each(begun.begin(), begun.end(), [&](PairKey key) { pairs.listToAsk(key); });
    }
    joinMobile(pairs, parallelFor);
    findAgainstResting(pairs, parallelFor);
    if (pairs.proxies.areRegrouped) {
        listRegrouped(pairs);
    }
    if (pairs.known.immediate.size() > 0) {
        std::erase_if(pairs.call.asked,
                      [&](PairKey key) { return pairs.known.immediate.contains(key); });
    }
    findSwept(pairs, parallelFor);
    listRefusedAgain(pairs);
    return true;
}

}  // namespace hashphase::detail
