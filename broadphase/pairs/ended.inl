// SPDX-License-Identifier: Zlib
#pragma once

// Which candidates overlap no more.

#include <broadphase/pairs/groups.inl>
#include <broadphase/pairs/settled.inl>
#include <broadphase/pairs/watched.inl>

#include <broadphase/core/compiler.hpp>
#include <broadphase/geometry/padded_box.hpp>

namespace hashphase::detail {

template <class Scalar>
void endIfWokenApart(PairState<Scalar>& pairs, std::uint32_t a, std::uint32_t b) {
    if (!pairs.proxies.boxesAtUpdate.empty() && !pairs.store.overlappedAtUpdate(a, b)) {
        return;  // a shift of the origin has rounded them together
    }
    const PairKey key = pairKey(a, b);
    pairs.known.wake(key);
    pairs.endIfSeparated(key);
    if (pairs.proxies.areRegrouped) {
        pairs.keepIfPair(key);
    }
}

// Lists in `bounds` the boxes that the woken ones had; returns the kinds of their groups.
template <class Scalar>
GroupKinds::Set listWoken(PairState<Scalar>& pairs) {
    Population<Scalar>& proxies = pairs.proxies;
    const ProxyGroups* const groups = proxies.groupsOfAllAtUpdate();
    GroupKinds::Set kinds = 0;
    pairs.scratch.bounds.clear();
    for (const std::uint32_t proxyIndex : proxies.woken) {
        pairs.scratch.bounds.push(pairs.store.before(proxyIndex));
        if (groups != nullptr) {
            kinds |=
                GroupKinds::bit(proxies.groupKinds.numberOf(groups[2 * std::size_t{proxyIndex}]));
        }
    }
    return kinds;
}

// Candidates of two that rest are not watched. When one wakes, its candidates are those of its box before:
// found in the resting table where the other one has not changed, and among the woken otherwise.
template <class Scalar>
void findEndedOfWoken(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& resting = pairs.tables.resting;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    const GroupKinds::Set kinds = listWoken(pairs);
    const GroupKinds::Set restingKinds = pairs.tables.restingKinds;
    const ProxyGroups* const groups = proxies.groupsOfAllAtUpdate();
    const GroupsView view{groups, proxies.woken.data(), proxies.groupKinds.together(restingKinds)};
    KernelCost cost;
    scratch.selected.clear();
    queryTable(resting, scratch.bounds.columns(), scratch.bounds.size(), parallelFor, scratch.parts,
               scratch.selected, cost,
               proxies.groupKinds.refuse(kinds, restingKinds) ? &view : nullptr);
    for (const auto [woken, entry] : scratch.selected.pairs()) {
        endIfWokenApart(pairs, proxies.woken[woken], resting.proxyIndex(entry));
    }
    if (proxies.woken.size() > 1) {
        const ProxyGroups* const some = proxies.groupKinds.refuse(kinds, kinds) ? groups : nullptr;
        const Table<Scalar>& table = pairs.lastUpdate.file(proxies.woken, parallelFor, some);
        scratch.selected.clear();
        joinTable(table, parallelFor, scratch.parts, scratch.selected, cost, some,
                  proxies.groupKinds.together(kinds));
        for (const auto [a, b] : scratch.selected.pairs()) {
            endIfWokenApart(pairs, table.proxyIndex(a), table.proxyIndex(b));
        }
    }
    pairs.cost.boxesTested += cost.boxesTested;
}

// What was watched, and has parted.
template <class Scalar>
void findEndedOfWatched(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const std::vector<PaddedBox<Scalar>>& now = pairs.store.frame.now;
    const auto amongMobile = pairs.watched.amongMobile.pairs();
    const auto toResting = pairs.watched.toResting.pairs();
    pairs.cost.pairsWatched = amongMobile.size() + toResting.size();
    listKeys(selectApart<Scalar>(pairs.scratch, amongMobile, nullptr, now.data(), parallelFor),
             proxies.mobile.data(), pairs.call.ended, parallelFor);
    constexpr std::size_t kAhead = 12;
    for (std::size_t i = 0; i < toResting.size(); ++i) {
        if (i + kAhead < toResting.size()) {
            prefetch(&proxies.records[toResting[i + kAhead].b]);
        }
        const auto [place, proxyIndex] = toResting[i];
        const Aabb<Scalar>& resting = proxies.standingBox(proxies.records[proxyIndex]);
        if (!overlaps(unpadded(now[place]), resting)) {
            pairs.call.ended.push_back(pairKey(proxies.mobile[place], proxyIndex));
        }
    }
}

// A candidate ends when its boxes overlapped at the last update, or it was found between updates, and they do not
// now, or when one of the two sweeps now, unless they touch on their ways, see findSwept(). All those
// that are not watched are found here before their boxes are lost.
template <class Scalar>
void findEnded(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    pairs.lastUpdate.forget();
    if (pairs.known.arePairs()) {
        return;  // see findBegunOfPairs()
    }
    findEndedOfWatched(pairs, parallelFor);
    for (const PairKey key : pairs.known.immediate.keys()) {
        pairs.endIfSeparated(key);
    }
    findEndedOfWoken(pairs, parallelFor);
    findKept(pairs);
}

}  // namespace hashphase::detail
