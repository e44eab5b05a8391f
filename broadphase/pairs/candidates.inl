// SPDX-License-Identifier: Zlib
#pragma once

// Which candidates were known at the last update, or have been found since, and which have come to overlap:
// of one proxy, or of all.

#include <broadphase/pairs/pair_state.hpp>

#include <broadphase/search/box_search.hpp>
#include <broadphase/search/join.hpp>

#include <algorithm>
#include <bit>

namespace hashphase::detail {

// Calls visit(index) for each entry of the table whose box overlaps.
template <class Scalar, class Visit>
void forEachTouching(SearchScratch<Scalar>& scratch, const Table<Scalar>& table,
                     const Aabb<Scalar>& box, const Visit& visit) {
    scratch.bounds.clear();
    scratch.bounds.push(box);
    KernelCost cost;
    const auto take = [&](std::span<const IndexPair> found) {
        for (const auto [query, entry] : found) {
            visit(table.proxyIndex(entry));
        }
        return true;
    };
    static_cast<void>(searchBoxes(table, scratch.bounds.columns(), 1, take, cost));
}

// Calls visit(key) for each candidate of the proxy that overlapped at the last update.
template <class Scalar, class Visit>
void forEachOverlapAtUpdate(PairState<Scalar>& pairs, std::uint32_t proxyIndex,
                            const Visit& visit) {
    constexpr std::size_t kFew = 64;
    const Population<Scalar>& proxies = pairs.proxies;
    LastUpdate<Scalar>& last = pairs.lastUpdate;
    last.index(kFew + (proxies.mobileAtUpdate + last.indexedWoken) / 4);
    const auto visitIfTheyDid = [&](std::uint32_t other) {
        if (other != proxyIndex && pairs.wasCandidate(pairKey(proxyIndex, other))) {
            visit(pairKey(proxyIndex, other));
        }
    };
    const Aabb<Scalar> before = pairs.store.before(proxyIndex);
    const Aabb<Scalar> inTable = last.place == LastUpdate<Scalar>::Place::ownTable
                                     ? pairs.store.boxAtUpdate(proxyIndex)
                                     : before;
    forEachTouching(pairs.scratch, last.table(), inTable, visitIfTheyDid);
    forEachTouching(pairs.scratch, pairs.tables.resting, before, visitIfTheyDid);
    for (std::size_t i = last.indexedWoken; i < proxies.woken.size(); ++i) {
        visitIfTheyDid(proxies.woken[i]);
    }
}

template <class Scalar, class Visit>
void forEachSwept(PairState<Scalar>& pairs, std::uint32_t proxyIndex, const Visit& visit) {
    SweptPairs& swept = pairs.known.swept;
    if (swept.atUpdate.empty()) {
        return;
    }
    if (swept.bySecond.empty()) {
        std::vector<PairKey> turned(swept.atUpdate.size());
        std::transform(swept.atUpdate.begin(), swept.atUpdate.end(), turned.begin(),
                       [](PairKey key) { return std::rotl(key, 32); });
        pairs.sort(turned);
        swept.bySecond.swap(turned);
    }
    for (const auto* keys : {&swept.atUpdate, &swept.bySecond}) {
        auto at = std::lower_bound(keys->begin(), keys->end(), PairKey{proxyIndex} << 32);
        for (; at != keys->end() && *at >> 32 == proxyIndex; ++at) {
            visit(pairKey(firstIndex(*at), secondIndex(*at)));
        }
    }
}

// Calls visit(key) for each candidate of the proxy that is known.
template <class Scalar, class Visit>
void forEachKnown(PairState<Scalar>& pairs, std::uint32_t proxyIndex, const Visit& visit) {
    forEachOverlapAtUpdate(pairs, proxyIndex, visit);
    pairs.known.immediate.forEachOf(proxyIndex, visit);
    forEachSwept(pairs, proxyIndex, visit);
}

// The same of all; some twice, where they are immediate or kept.
template <class Scalar, class Visit>
void forEachKnown(PairState<Scalar>& pairs, const Visit& visit) {
    const Population<Scalar>& proxies = pairs.proxies;
    const KnownPairs& known = pairs.known;
    const Table<Scalar>& resting = pairs.tables.resting;
    const ProxyGroups* const groups = proxies.groupsOfAllAtUpdate();
    const auto visitIfTheyDid = [&](std::uint32_t a, std::uint32_t b) {
        if (pairs.wasCandidate(pairKey(a, b))) {
            visit(pairKey(a, b));
        }
    };
    pairs.lastUpdate.index(0);
    const Table<Scalar>& table = pairs.lastUpdate.table();
    KernelCost cost;
    forOverlaps(table, groups, cost, visitIfTheyDid);
    forOverlaps(resting, groups, cost, visitIfTheyDid);
    BoxColumns<Scalar>& bounds = pairs.scratch.bounds;
    bounds.clear();
    for (const std::uint32_t proxyIndex : table.proxyIndices()) {
        bounds.push(pairs.store.before(proxyIndex));
    }
    const GroupsView view{groups, table.proxyIndices().data(), {}};
    forOverlaps(bounds.columns(), bounds.size(), resting, groups != nullptr ? &view : nullptr, cost,
                [&](std::uint32_t entry, std::uint32_t other) {
                    visitIfTheyDid(table.proxyIndex(entry), other);
                });
    for (const std::span<const PairKey> keys : {known.immediate.keys(), known.kept.keys(),
                                                std::span<const PairKey>(known.swept.atUpdate)}) {
        std::for_each(keys.begin(), keys.end(), visit);
    }
    const std::span<const PairKey> remembered =
        known.arePairs() ? known.pile->pairs.keys() : std::span<const PairKey>();
    for (const PairKey key : remembered) {  // that are kept
        if (!pairs.couldPair(key) && !known.immediate.contains(key) && !known.swept.contains(key)) {
            visit(key);
        }
    }
}

template <class Scalar>
void listIfNew(PairState<Scalar>& pairs, PairKey key) {
    if (pairs.mayPairNow(key) && pairs.touchAtStart(key) && !pairs.isKnown(key)) {
        pairs.call.immediate.push_back(key);
        pairs.listToAsk(key);
    }
}

// Lists those that sweep by a box of their own which is not within the one that the grid finds.
template <class Scalar>
void listStrays(PairState<Scalar>& pairs) {
    std::vector<std::uint32_t>& strays = pairs.scratch.entryOf;
    strays.clear();
    if (pairs.sweeping == nullptr) {
        return;
    }
    for (const Motion<Scalar>& motion : pairs.sweeping->motions.all) {
        if (!motion.isFromGrid && pairs.proxies.contains(motion.id) &&
            !Store<Scalar>::staysWithin(motion.way.box,
                                        pairs.proxies.records[motion.id.index].box)) {
            strays.push_back(motion.id.index);
        }
    }
}

// Lists, to be asked about, the proxy's candidates that overlap now and are not known: those with others
// that are wanted. After listStrays(). Of two candidates, each finds the other.
template <class Scalar, class IsWanted>
void findNewCandidates(PairState<Scalar>& pairs, std::uint32_t proxyIndex,
                       const IsWanted& isWanted) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Aabb<Scalar> box = pairs.boxAtStart(proxyIndex);
    const auto add = [&](std::uint32_t other) {
        if (other != proxyIndex && isWanted(other)) {
            listIfNew(pairs, pairKey(proxyIndex, other));
        }
    };
    const Reading<Scalar> reading = pairs.store.beginReading();
    for (const Filing<Scalar>& filing : reading.filings()) {
        forEachTouching(pairs.scratch, *filing.table, box, [&](std::uint32_t other) {
            if (pairs.store.standsIn(filing, other, reading)) {
                add(other);
            }
        });
    }
    for (std::size_t i = 0; i < proxies.waiting.size() && !reading.isFresh; ++i) {
        const std::uint32_t other = proxies.waiting[i];
        if (proxies.isAlive(other) && overlaps(box, proxies.records[other].box)) {
            add(other);
        }
    }
    for (const std::uint32_t other : pairs.scratch.entryOf) {
        if (!overlaps(box, proxies.records[other].box)) {  // or it has been found
            add(other);
        }
    }
}

}  // namespace hashphase::detail
