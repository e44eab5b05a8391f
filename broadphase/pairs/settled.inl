// SPDX-License-Identifier: Zlib
#pragma once

// Candidates of two that are settled, and move within the boxes by which they are filed.

#include <broadphase/pairs/watched.inl>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>

namespace hashphase::detail {

// So many pairs are tested by a thread at a time.
inline constexpr std::uint32_t kTurnedPart = 8192;

// Lists the numbers of each entry's pairs.
inline void listPairsOf(SettledPairs& settled, std::size_t entryCount) {
    settled.firstOf.assign(entryCount + 1, 0);
    for (const auto [a, b] : settled.pairs.pairs()) {
        ++settled.firstOf[a];
        ++settled.firstOf[b];
    }
    std::inclusive_scan(settled.firstOf.begin(), settled.firstOf.end(), settled.firstOf.begin());
    settled.pairsOf.resize(2 * settled.pairs.size());
    for (auto i = static_cast<std::uint32_t>(settled.pairs.size()); i > 0;) {
        --i;
        const auto [a, b] = settled.pairs.pairs()[i];
        settled.pairsOf[--settled.firstOf[a]] = i;
        settled.pairsOf[--settled.firstOf[b]] = i;
    }
}

// Calls take(i), which notes it, for each of the pairs that has come to overlap or to be apart.
template <class Scalar, class Take>
void forEachTurned(PairState<Scalar>& pairs, ParallelFor parallelFor, const Take& take) {
    const Table<Scalar>& table = pairs.tables.resting;
    const Columns<Scalar> columns = table.columns();
    SettledPairs& settled = *pairs.watched.settled;
    const auto select = [&](std::uint32_t first, std::uint32_t last, std::uint32_t* turned) {
        return kernels<Scalar>().selectTurned(settled.pairs.pairs().data(),
                                              settled.overlapped.data(), first, last,
                                              columns.data(), turned);
    };
    const auto count = static_cast<std::uint32_t>(settled.pairs.size());
    if (pairs.store.settling->areManyChanged) {
        pairs.cost.pairsWatched += count;
        settled.turned.resize(count);
        settled.turnedInPart.resize((count + kTurnedPart - 1) / kTurnedPart);
        parallelFor(settled.turnedInPart.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (auto part = static_cast<std::uint32_t>(begin); part < end; ++part) {
                const std::uint32_t first = part * kTurnedPart;
                settled.turnedInPart[part] = select(first, std::min(first + kTurnedPart, count),
                                                    settled.turned.data() + first);
            }
        });
        for (std::uint32_t part = 0; part < settled.turnedInPart.size(); ++part) {
            const auto turned = std::span(settled.turned).subspan(part * std::size_t{kTurnedPart});
            std::ranges::for_each(turned.first(settled.turnedInPart[part]), take);
        }
        return;
    }
    const std::vector<std::uint32_t>& changed = pairs.store.settling->changedEntries;
    if (settled.firstOf.empty() && !changed.empty()) {
        listPairsOf(settled, table.size());
    }
    for (const std::uint32_t entry : changed) {
        const std::uint32_t end = settled.firstOf[entry + 1];
        for (std::uint32_t k = settled.firstOf[entry]; k < end; ++k) {
            std::uint32_t turned = 0;
            if (select(settled.pairsOf[k], settled.pairsOf[k] + 1, &turned) > 0) {
                take(turned);
            }
        }
        pairs.cost.pairsWatched += end - settled.firstOf[entry];
    }
}

// Once their table has been refreshed: finds which of the pairs have begun, which findBegun() asks about, and
// ended.
template <class Scalar>
void findTurned(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    if (pairs.watched.settled == nullptr) {
        return;
    }
    const Table<Scalar>& table = pairs.tables.resting;
    SettledPairs& settled = *pairs.watched.settled;
    settled.begun.clear();
    if (!table.isSettled() || pairs.proxies.settledChanged == 0) {
        return;
    }
    forEachTurned(pairs, parallelFor, [&](std::uint32_t i) {
        const auto [a, b] = settled.pairs.pairs()[i];
        const PairKey key = pairKey(table.proxyIndex(a), table.proxyIndex(b));
        settled.overlapped[i] ^= 1;
        if (settled.overlapped[i] != 0) {
            settled.begun.push_back(key);
        } else if (pairs.areAtRest(key)) {
            pairs.call.ended.push_back(key);
        }
    });
}

// Finds what overlaps in the resting table, may pair, and has slack. Where few have it, they look for the others.
template <class Scalar>
void findFiledPairs(PairState<Scalar>& pairs, PairList& found, ParallelFor parallelFor) {
    constexpr std::size_t kFew = 4;
    const Table<Scalar>& table = pairs.tables.resting;
    const GroupKinds::Set kinds = pairs.tables.restingKinds;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    const auto hasSlack = [&](std::uint32_t proxyIndex) {
        return bool{pairs.proxies.records[proxyIndex].hasSlack};
    };
    const auto hasSlackThere = [&](std::uint32_t entry) {
        return hasSlack(table.proxyIndex(entry));
    };
    const auto indices = table.proxyIndices();
    const auto count = std::count_if(indices.begin(), indices.end(), hasSlack);
    if (kFew * static_cast<std::size_t>(count) > indices.size()) {
        joinAllowed(pairs, table, kinds, found, parallelFor);
        takeOut(found, [&](const IndexPair& pair) {
            return !hasSlackThere(pair.a) && !hasSlackThere(pair.b);
        });
        return;
    }
    listSearched(pairs, table, hasSlack);
    queryAllowed(pairs, scratch.bounds.columns(), std::span(scratch.searchedIndices), kinds, table,
                 kinds, found, parallelFor);
    for (IndexPair& pair : found.all()) {
        pair.a = scratch.searchedEntries[pair.a];
    }
    takeOut(found, [&](const IndexPair& pair) {  // itself, and what finds it as well
        return pair.a == pair.b || (pair.b < pair.a && hasSlackThere(pair.b));
    });
}

// When their table has been filed anew, and has not been refreshed: lists what overlaps by the boxes by which it
// is filed, may pair, and has slack. What rested before has been dealt with by findTurned(); of what joins,
// which was mobile until now, pairs that ended are found.
template <class Scalar>
void listSettled(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const Population<Scalar>& proxies = pairs.proxies;
    const Table<Scalar>& table = pairs.tables.resting;
    if (!table.isSettled()) {
        if (pairs.watched.settled != nullptr) {
            pairs.watched.settled->clear();
        }
        return;
    }
    if (pairs.tables.settledAt != proxies.updateNumber) {
        return;
    }
    if (pairs.watched.settled == nullptr) {
        pairs.watched.settled = std::make_unique<SettledPairs>();
    }
    SettledPairs& settled = *pairs.watched.settled;
    settled.clear();
    findFiledPairs(pairs, settled.pairs, parallelFor);
    const auto hasJoined = [&](std::uint32_t entry) {
        return table.order()[entry] >= pairs.store.settling->stayedCount;
    };
    // Room for what later updates list, so that these take no memory.
    ensureCapacity(settled.overlapped, settled.pairs.size());
    ensureCapacity(settled.turned, settled.pairs.size());
    ensureCapacity(settled.turnedInPart, settled.pairs.size() / kTurnedPart + 1);
    ensureCapacity(settled.pairsOf, 2 * settled.pairs.size());
    ensureCapacity(settled.firstOf, table.size() + std::size_t{1});
    for (const auto [a, b] : settled.pairs.pairs()) {
        const PairKey key = pairKey(table.proxyIndex(a), table.proxyIndex(b));
        const bool overlapNow = pairs.overlapNow(key);
        settled.overlapped.push_back(overlapNow ? 1 : 0);
        if (overlapNow && (hasJoined(a) || hasJoined(b)) &&
            !pairs.store.overlappedAtUpdate(firstIndex(key), secondIndex(key))) {
            settled.begun.push_back(key);
        }
    }
}

}  // namespace hashphase::detail
