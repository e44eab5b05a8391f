// SPDX-License-Identifier: Zlib
#pragma once

// The candidates that are watched, and those that tables have.

#include <broadphase/pairs/pair_state.hpp>

#include <broadphase/search/join.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::detail {

// Those candidates of which the boxes, numbered order[a] and order[b], do not overlap; valid until the
// next call.
template <class Scalar>
std::span<const IndexPair> selectApart(SearchScratch<Scalar>& scratch,
                                       std::span<const IndexPair> candidates,
                                       const std::uint32_t* order, const PaddedBox<Scalar>* boxes,
                                       ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 8192;
    scratch.selected.clear();
    KernelCost none;
    const auto select = [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost&) {
        makeRoom(sink, last - first);
        sink.next += kernels<Scalar>().selectApart(candidates.data() + first, last - first, order,
                                                   boxes, sink.next);
    };
    scratch.parts.collect(parallelFor, candidates.size(), kGrain, scratch.selected, none, select);
    return scratch.selected.pairs();
}

// Adds the keys of the pairs, of which the proxies are numbered, in their order.
inline void listKeys(std::span<const IndexPair> pairs, const std::uint32_t* proxyIndices,
                     std::vector<PairKey>& keys, ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 4096;
    const std::size_t first = keys.size();
    keys.resize(first + pairs.size());
    parallelFor(pairs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            keys[first + i] = pairKey(proxyIndices[pairs[i].a], proxyIndices[pairs[i].b]);
        }
    });
}

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

// Lists every two entries of the table, which have such kinds of groups, that overlap and may pair.
template <class Scalar>
void joinAllowed(PairState<Scalar>& pairs, const Table<Scalar>& table, GroupKinds::Set kinds,
                 PairList& found, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const bool someRefuse = proxies.groupKinds.refuse(kinds, kinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    KernelCost cost;
    found.clear();
    joinTable(table, parallelFor, pairs.scratch.parts, found, cost,
              areToldApart ? proxies.groups.data() : nullptr, proxies.groupKinds.together(kinds));
    if (someRefuse && !areToldApart) {
        takeOut(found, [&](const IndexPair& pair) {
            return proxies.doRefuse(table.proxyIndex(pair.a), table.proxyIndex(pair.b));
        });
    }
    pairs.cost.boxesTested += cost.boxesTested;
}

// Lists (i, entry) for what boxes, those of these proxies, which are of such kinds, overlap in a table and may
// pair with.
template <class Scalar>
void queryAllowed(PairState<Scalar>& pairs, const Columns<Scalar>& boxes,
                  std::span<const std::uint32_t> ofProxies, GroupKinds::Set kinds,
                  const Table<Scalar>& table, GroupKinds::Set tableKinds, PairList& found,
                  ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const bool someRefuse = proxies.groupKinds.refuse(kinds, tableKinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    const GroupsView view{proxies.groups.data(), ofProxies.data(),
                          proxies.groupKinds.together(tableKinds)};
    KernelCost cost;
    found.clear();
    queryTable(table, boxes, static_cast<std::uint32_t>(ofProxies.size()), parallelFor,
               pairs.scratch.parts, found, cost, areToldApart ? &view : nullptr);
    pairs.cost.boxesTested += cost.boxesTested;
    if (someRefuse && !areToldApart) {
        takeOut(found, [&](const IndexPair& pair) {
            return proxies.doRefuse(ofProxies[pair.a], table.proxyIndex(pair.b));
        });
    }
}

// Calls visit(key) for each candidate that was watched, before the frame files anew.
template <class Scalar, class Visit>
void forEachWatched(const PairState<Scalar>& pairs, const Visit& visit) {
    const std::vector<std::uint32_t>& mobile = pairs.proxies.mobile;
    for (const auto [a, b] : pairs.watched.amongMobile.pairs()) {
        visit(pairKey(mobile[a], mobile[b]));
    }
    for (const auto [place, proxyIndex] : pairs.watched.toResting.pairs()) {
        visit(pairKey(mobile[place], proxyIndex));
    }
}

// Lists the entries of the table whose proxies are to be searched, these proxies and their boxes.
template <class Scalar, class IsSearched>
void listSearched(PairState<Scalar>& pairs, const Table<Scalar>& table,
                  const IsSearched& isSearched) {
    SearchScratch<Scalar>& scratch = pairs.scratch;
    scratch.searchedEntries.clear();
    scratch.searchedIndices.clear();
    scratch.bounds.clear();
    for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
        const std::uint32_t proxyIndex = table.proxyIndex(entry);
        if (isSearched(proxyIndex)) {
            scratch.searchedEntries.push_back(entry);
            scratch.searchedIndices.push_back(proxyIndex);
            scratch.bounds.push(table.box(entry));
        }
    }
}

template <class Scalar>
void listChanged(PairState<Scalar>& pairs) {
    listSearched(pairs, pairs.tables.mobile,
                 [&](std::uint32_t index) { return pairs.proxies.changedNow(index); });
}

// Finds all candidates that are to be watched, in the tables as they are.
template <class Scalar>
void watchAll(PairState<Scalar>& pairs) {
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const Table<Scalar>& resting = pairs.tables.resting;
    WatchedPairs& watched = pairs.watched;
    PairParts& parts = pairs.scratch.parts;
    const ProxyGroups* const groups = pairs.proxies.groupsOfAll();
    const GroupsView view{groups, mobile.proxyIndices().data(), {}};
    KernelCost cost;
    watched.amongMobile.clear();
    watched.carried.clear();
    watched.toResting.clear();
    joinTable(mobile, serialFor, parts, watched.amongMobile, cost, groups);
    queryTable(resting, mobile.columns(), mobile.size(), serialFor, parts, watched.carried, cost,
               groups != nullptr ? &view : nullptr);
    for (const auto [entry, restingEntry] : watched.carried.pairs()) {
        watched.toResting.push({entry, resting.proxyIndex(restingEntry)});
    }
    pairs.cost.boxesTested += cost.boxesTested;
}

template <class Scalar, class Visit>
void forEachOverlapOfFew(const PairState<Scalar>& pairs, const Visit& visit) {
    std::vector<std::uint32_t> alive;
    pairs.store.forEachListed([&](std::uint32_t proxyIndex) {
        if (pairs.proxies.isAlive(proxyIndex)) {
            alive.push_back(proxyIndex);
        }
    });
    for (std::size_t i = 0; i < alive.size(); ++i) {
        for (std::size_t k = i + 1; k < alive.size(); ++k) {
            const PairKey key = pairKey(alive[i], alive[k]);
            if (pairs.overlapNow(key) && pairs.mayPairNow(key)) {
                visit(alive[i], alive[k]);
            }
        }
    }
}

// Calls visit(a, b) for every two that overlap and may pair, found from scratch.
template <class Scalar, class Visit>
void forEachOverlap(const PairState<Scalar>& pairs, const Visit& visit) {
    pairs.store.mendTables();
    if (pairs.store.areFewListed()) {
        forEachOverlapOfFew(pairs, visit);
        return;
    }
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const Table<Scalar>& resting = pairs.tables.resting;
    const ProxyGroups* const groups = pairs.proxies.groupsOfAll();
    KernelCost cost;
    forOverlaps(mobile, groups, cost, visit);
    forOverlaps(resting, groups, cost, visit);
    const GroupsView view{groups, mobile.proxyIndices().data(), {}};
    forOverlaps(
        mobile.columns(), mobile.size(), resting, groups != nullptr ? &view : nullptr, cost,
        [&](std::uint32_t entry, std::uint32_t other) { visit(mobile.proxyIndex(entry), other); });
}

}  // namespace hashphase::detail
