// SPDX-License-Identifier: Zlib
#pragma once

// Which candidates have come to overlap.

#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/groups.inl>
#include <broadphase/pairs/remembered.inl>
#include <broadphase/pairs/swept.inl>
#include <broadphase/pairs/watched.inl>

#include <algorithm>

namespace hashphase::detail {

// Where only a few share a cell, what may not pair is sooner taken out of what a search has found, where
// it is little, than left out by the search, which has to look at the groups of all.
template <class Scalar>
bool isCrowded(const Table<Scalar>& table) {
    constexpr std::uint32_t kFew = 32;
    return mostTogether(table) > kFew;
}

template <class IsOut>
void takeOut(PairList& candidates, const IsOut& isOut) {
    IndexPair* const begin = candidates.resize(candidates.size());
    IndexPair* const end = std::remove_if(begin, begin + candidates.size(), isOut);
    static_cast<void>(candidates.resize(static_cast<std::size_t>(end - begin)));
}

// Candidates of a mobile one that has not changed and a resting one are not looked for again.
template <class Scalar>
void carryToRest(PairState<Scalar>& pairs, bool someSettled) {
    const Population<Scalar>& proxies = pairs.proxies;
    WatchedPairs& watched = pairs.watched;
    watched.carried.clear();
    if (pairs.tables.resting.size() == 0) {
        return;
    }
    const auto carryIfKept = [&](std::uint32_t place, std::uint32_t resting) {
        const std::uint32_t mobile = proxies.mobile[place];
        const bool isKept = proxies.records[resting].residency == Residency::resting &&
                            proxies.records[mobile].residency == Residency::mobile &&
                            !proxies.changedNow(mobile);
        if (isKept) {
            watched.carried.push({pairs.scratch.entryOf[place], resting});
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
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& table = pairs.tables.mobile;
    PairList& found = pairs.watched.amongMobile;
    found.clear();
    const GroupKinds::Set kinds = pairs.frame.mobileKinds;
    const bool someRefuse = proxies.groupKinds.refuse(kinds, kinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    KernelCost cost;
    joinTable(table, parallelFor, pairs.scratch.parts, found, cost,
              areToldApart ? proxies.groups.data() : nullptr, proxies.groupKinds.together(kinds));
    if (someRefuse && !areToldApart) {
        takeOut(found, [&](const IndexPair& pair) {
            return proxies.doRefuse(table.proxyIndex(pair.a), table.proxyIndex(pair.b));
        });
    }
    pairs.cost.boxesTested += cost.boxesTested;
    for (const auto [a, b] : selectApart<Scalar>(pairs.scratch, found.pairs(), table.order().data(),
                                                 pairs.frame.before.data(), parallelFor)) {
        pairs.listToAsk(pairKey(table.proxyIndex(a), table.proxyIndex(b)));
    }
}

// Selects all that overlap and may pair: a place in changedEntries and an entry at rest.
template <class Scalar>
void queryResting(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& resting = pairs.tables.resting;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    const GroupKinds::Set restingKinds = pairs.tables.restingKinds;
    const bool someRefuse = proxies.groupKinds.refuse(pairs.frame.changedKinds, restingKinds);
    const bool areToldApart = someRefuse && isCrowded(resting);
    listChanged(pairs);
    const GroupsView view{proxies.groups.data(), scratch.searchedIndices.data(),
                          proxies.groupKinds.together(restingKinds)};
    KernelCost cost;
    scratch.selected.clear();
    queryTable(resting, scratch.bounds.columns(), scratch.bounds.size(), parallelFor, scratch.parts,
               scratch.selected, cost, areToldApart ? &view : nullptr);
    pairs.cost.boxesTested += cost.boxesTested;
    if (someRefuse && !areToldApart) {
        takeOut(scratch.selected, [&](const IndexPair& pair) {
            return proxies.doRefuse(scratch.searchedIndices[pair.a], resting.proxyIndex(pair.b));
        });
    }
}

// What changed against the resting proxies.
template <class Scalar>
void findAgainstResting(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const Table<Scalar>& resting = pairs.tables.resting;
    WatchedPairs& watched = pairs.watched;
    watched.toResting.swap(watched.carried);
    if (resting.size() == 0) {
        return;
    }
    queryResting(pairs, parallelFor);
    const bool isShifted = !pairs.proxies.boxesAtUpdate.empty();
    for (const auto [changed, restingEntry] : pairs.scratch.selected.pairs()) {
        const std::uint32_t entry = pairs.scratch.changedEntries[changed];
        const std::uint32_t proxyIndex = resting.proxyIndex(restingEntry);
        watched.toResting.push({entry, proxyIndex});
        // Not by their indices: these boxes are at hand.
        const PaddedBox<Scalar>& before = pairs.frame.before[mobile.order()[entry]];
        const Aabb<Scalar> other =
            isShifted ? pairs.proxies.boxAtUpdate(proxyIndex) : resting.box(restingEntry);
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
    const auto order = pairs.tables.mobile.order();
    pairs.scratch.entryOf.resize(pairs.proxies.mobile.size());
    for (std::uint32_t entry = 0; entry < order.size(); ++entry) {
        pairs.scratch.entryOf[order[entry]] = entry;
    }
    carryToRest(pairs, someSettled);
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
