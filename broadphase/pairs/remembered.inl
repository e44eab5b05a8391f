// SPDX-License-Identifier: Zlib
#pragma once

// Which side Pairs remember of what overlaps: what the filter refused, which mostly is little, or the pairs.
//
// Where the pairs are, an update is what it would be without all that is kept to make it fast: a pair ends
// when the two are apart; and of all that what has changed overlaps, the filter is asked about what is no
// pair, in parts.

#include <broadphase/core/caught.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/pairs/candidates.inl>
#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/watched.inl>

#include <algorithm>
#include <memory>
#include <utility>

namespace hashphase::detail {

// How many are remembered of the refused ones.
template <class Scalar>
[[nodiscard]] std::size_t mostRefused(const PairState<Scalar>& pairs) noexcept {
    return 32 * pairs.store.listedCount() + 4 * pairs.known.count;
}

inline Pile& pileOf(KnownPairs& known) {
    if (known.pile == nullptr) {
        known.pile = std::make_unique<Pile>();
    }
    return *known.pile;
}

// --- Samples -------------------------------------------------------------------------------------

// Of `count` searches, how many tell what all find: so few that they cost little, and find little more than
// may be watched.
template <class Scalar>
[[nodiscard]] std::size_t sampleSize(const Table<Scalar>& table, std::size_t count) {
    constexpr std::size_t kMost = 1024;
    return std::min({kMost, 1 + count / 32, 1 + 16 * count / mostTogether(table), count});
}

// Selects some of what overlaps in a table that is not empty. Returns for how many candidates each of them
// stands.
template <class Scalar>
[[nodiscard]] double sampleOverlaps(PairState<Scalar>& pairs, const Table<Scalar>& table) {
    const std::size_t size = sampleSize(table, table.size());
    std::size_t searches = 0;
    KernelCost cost;
    pairs.scratch.selected.clear();
    pairs.scratch.selected.append([&](PairSink& sink) {
        searches = joinSample(table, size, sink, cost, pairs.proxies.groupsOfAll());
    });
    pairs.cost.boxesTested += cost.boxesTested;
    return static_cast<double>(searches) / static_cast<double>(size);
}

// Lists in `asked` some of what overlaps among the mobile ones. Returns, as the next one, for how many
// candidates each of them stands.
template <class Scalar>
[[nodiscard]] double sampleMobile(PairState<Scalar>& pairs) {
    const Table<Scalar>& mobile = pairs.tables.mobile;
    const double weight = sampleOverlaps(pairs, mobile);
    for (const auto [a, b] : pairs.scratch.selected.pairs()) {
        pairs.listToAsk(pairKey(mobile.proxyIndex(a), mobile.proxyIndex(b)));
    }
    return weight;
}

// The same of what has changed against the resting ones.
template <class Scalar>
[[nodiscard]] double sampleResting(PairState<Scalar>& pairs) {
    const Table<Scalar>& mobile = pairs.tables.mobile;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    listChanged(pairs);
    const std::size_t count = scratch.searchedEntries.size();
    const std::size_t size = sampleSize(pairs.tables.resting, count);
    scratch.bounds.clear();
    scratch.searchedIndices.clear();
    for (std::size_t i = 0; i < size; ++i) {
        const std::uint32_t entry = scratch.searchedEntries[count * i / size];
        scratch.searchedIndices.push_back(mobile.proxyIndex(entry));
        scratch.bounds.push(mobile.box(entry));
    }
    const ProxyGroups* const groups = pairs.proxies.groupsOfAll();
    const GroupsView view{groups, scratch.searchedIndices.data(), {}};
    KernelCost cost;
    forOverlaps(scratch.bounds.columns(), scratch.bounds.size(), pairs.tables.resting,
                groups != nullptr ? &view : nullptr, cost,
                [&](std::uint32_t searched, std::uint32_t proxyIndex) {
                    pairs.listToAsk(pairKey(scratch.searchedIndices[searched], proxyIndex));
                });
    pairs.cost.boxesTested += cost.boxesTested;
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(size, 1));
}

// About how many of those are refused of which `asked` is a sample, each for `weight` of them. It is asked
// about only where so many are new that it may be asked in parts.
template <class Scalar>
[[nodiscard]] double countRefused(PairState<Scalar>& pairs, PairFilter filter, double weight) {
    PairCall& call = pairs.call;
    std::size_t refused = 0;
    std::erase_if(call.asked, [&](PairKey key) {
        const bool isKnown = pairs.isKnown(key);
        refused += isKnown && pairs.known.isRefused(key) ? 1 : 0;
        return isKnown || !pairs.mayPairNow(key);
    });
    if (weight * static_cast<double>(call.asked.size()) > PairState<Scalar>::kPart) {
        askFilter(pairs, filter);
        Pile& pile = *pairs.known.pile;
        for (std::size_t i = 0; i < call.asked.size(); ++i) {
            pile.sampled.findOrInsert(call.asked[i]);
            pile.sampledAccepted.push_back(call.accepted[i]);
            refused += call.accepted[i] == 0 ? 1 : 0;
        }
    }
    call.asked.clear();
    return weight * static_cast<double>(refused);
}

// Where many share a cell, a sample of what overlaps tells what the filter says to all of it. What is asked
// for that is not asked again.
template <class Scalar>
[[nodiscard]] bool doesRefuseMost(PairState<Scalar>& pairs, PairFilter filter) {
    constexpr std::uint32_t kMany = 128;
    const bool isMobileCrowded = mostTogether(pairs.tables.mobile) > kMany;
    const bool isRestingCrowded = mostTogether(pairs.tables.resting) > kMany;
    if (isMobileCrowded || isRestingCrowded) {
        static_cast<void>(pileOf(pairs.known));
    }
    double refused = isMobileCrowded ? countRefused(pairs, filter, sampleMobile(pairs)) : 0;
    refused += isRestingCrowded ? countRefused(pairs, filter, sampleResting(pairs)) : 0;
    return refused > static_cast<double>(mostRefused(pairs));
}

// --- From one side to the other ------------------------------------------------------------------

template <class Scalar>
void forgetWatched(PairState<Scalar>& pairs) noexcept {
    pairs.watched.amongMobile = {};
    pairs.watched.toResting = {};
    pairs.known.refused = {};
    pairs.known.refusedAtRest = {};
    pairs.known.kept = {};
}

// As of the last update, and what has been found since.
template <class Scalar>
void rememberPairs(PairState<Scalar>& pairs) {
    FlatSet remembered;
    forEachKnown(pairs, [&](PairKey key) {
        if (!pairs.known.isRefused(key)) {
            remembered.findOrInsert(key);
        }
    });
    Pile& pile = pileOf(pairs.known);
    pile.pairs = std::move(remembered);
    pile.hasPairs = true;
    // Seldomer each time, should it go to and fro.
    pile.lookInterval = std::max(pile.lookInterval, 1U);
    pile.updatesUntilLook = pile.lookInterval;
    forgetWatched(pairs);
    // What is settled is not looked for among what has changed.
    pairs.store.wakeSettled();
    pairs.store.maySettleWithSlack = false;
}

// By a sample first.
template <class Scalar>
[[nodiscard]] bool areOverlapsFew(PairState<Scalar>& pairs, std::size_t most) {
    for (const Table<Scalar>* table : {&pairs.tables.mobile, &pairs.tables.resting}) {
        const double weight = table->size() > 0 ? sampleOverlaps(pairs, *table) : 0;
        if (weight * static_cast<double>(pairs.scratch.selected.size()) >
            static_cast<double>(most)) {
            return false;
        }
    }
    std::size_t count = 0;
    forEachOverlap(pairs, [&](std::uint32_t, std::uint32_t) { ++count; });
    return count <= most;
}

// Directly after an update.
template <class Scalar>
void rememberRefusedIfFew(PairState<Scalar>& pairs) {
    if (!areOverlapsFew(pairs, mostRefused(pairs) / 2)) {  // not to come back with the next few
        return;
    }
    watchAll(pairs);
    KnownPairs& known = pairs.known;
    const auto refuse = [&](PairKey key) {
        if (!known.isRemembered(key)) {
            known.refused.findOrInsert(key);
        }
    };
    forEachOverlap(pairs, [&](std::uint32_t a, std::uint32_t b) { refuse(pairKey(a, b)); });
    std::for_each(known.swept.atUpdate.begin(), known.swept.atUpdate.end(), refuse);
    for (const PairKey key : known.pile->pairs.keys()) {
        if (!pairs.mayPairNow(key) && pairs.overlapNow(key)) {
            known.kept.findOrInsert(key);
        }
    }
    known.pile->hasPairs = false;
    known.pile->pairs = {};
    pairs.store.maySettleWithSlack = true;
}

// Whether the refused ones have become few again is looked at after 1, 2, 4, 8 ... updates: it may cost as much
// as finding all that overlap. From within a query, tables that it reads must not be filed anew: so the refused
// ones stay remembered until the next call.
template <class Scalar>
void chooseSide(PairState<Scalar>& pairs, bool isUpdated) noexcept {
    constexpr std::uint32_t kSeldom = 256;
    KnownPairs& known = pairs.known;
    const bool isChosen = hasRoomFor([&] {
        if (!known.arePairs()) {
            if (known.refusedCount() + known.immediate.size() > mostRefused(pairs) &&
                !pairs.store.mustRebuildPairs && !QueryScope::isWithin(&pairs.store)) {
                rememberPairs(pairs);
            }
        } else if (isUpdated && pairs.cost.grid.changed > 0 &&
                   --known.pile->updatesUntilLook == 0) {
            known.pile->lookInterval = std::min(2 * known.pile->lookInterval, kSeldom);
            known.pile->updatesUntilLook = known.pile->lookInterval;
            rememberRefusedIfFew(pairs);
        }
    });
    if (!isChosen && known.arePairs()) {  // what is remembered so far will do
        forgetWatched(pairs);
    }
}

// --- While the pairs are remembered --------------------------------------------------------------

// Asks about what there is to be asked, when that is `size` or more, and notes down what the answers change.
// Does nothing while the refused ones are remembered.
template <class Scalar>
void askInParts(PairState<Scalar>& pairs, PairFilter filter, std::size_t size) {
    PairCall& call = pairs.call;
    if (!pairs.known.arePairs() || call.asked.size() < size) {
        return;
    }
    pairs.sortAndUnite(call.asked);
    askFilter(pairs, filter);
    for (std::size_t i = 0; i < call.asked.size(); ++i) {
        if ((call.accepted[i] != 0) != pairs.known.isRemembered(call.asked[i])) {
            pairs.known.pile->turned.push_back(call.asked[i]);
        }
    }
    call.asked.clear();
    call.standing.clear();
    call.immediate.clear();
}

// As if only what the answers change had been asked.
template <class Scalar>
void takeTurned(PairState<Scalar>& pairs) {
    PairCall& call = pairs.call;
    call.asked.swap(pairs.known.pile->turned);
    pairs.sortAndUnite(call.asked);
    call.accepted.clear();
    for (const PairKey key : call.asked) {
        const bool isPair = pairs.known.isRemembered(key);
        call.accepted.push_back(isPair ? 0 : 1);
        if (isPair) {
            call.standing.push_back(key);
        }
    }
}

template <class Scalar>
void askAboutChanged(PairState<Scalar>& pairs, PairFilter filter) {
    const Population<Scalar>& proxies = pairs.proxies;
    SearchScratch<Scalar>& scratch = pairs.scratch;
    listChanged(pairs);
    const auto askUnlessPair = [&](std::uint32_t searched, std::uint32_t other) {
        const std::uint32_t proxyIndex = scratch.searchedIndices[searched];
        const bool isFoundByOther = proxies.changedNow(other) && other <= proxyIndex;
        const PairKey key = pairKey(proxyIndex, other);
        if (!isFoundByOther && !pairs.known.isRemembered(key)) {
            pairs.listToAsk(key);
            askInParts(pairs, filter, PairState<Scalar>::kPart);
        }
    };
    const ProxyGroups* const groups = proxies.groupsOfAll();
    const GroupsView view{groups, scratch.searchedIndices.data(), {}};
    KernelCost cost;
    for (const Table<Scalar>* table : {&pairs.tables.mobile, &pairs.tables.resting}) {
        forOverlaps(scratch.bounds.columns(), scratch.bounds.size(), *table,
                    groups != nullptr ? &view : nullptr, cost, askUnlessPair);
    }
    pairs.cost.boxesTested += cost.boxesTested;
}

template <class Scalar>
void findSweptOfPairs(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    KnownPairs& known = pairs.known;
    known.swept.now.clear();
    if (pairs.sweeping == nullptr) {
        return;
    }
    pairs.sweeping->search.find(pairs.sweeping->motions.all, parallelFor);
    for (const PairKey key : pairs.sweeping->search.contacts()) {
        const bool isPair = known.isRemembered(key);
        if (isPair || pairs.mayPairNow(key)) {
            known.swept.now.push_back(key);
            if (!isPair) {
                pairs.listToAsk(key);
            }
        }
    }
}

template <class Scalar>
void findBegunOfPairs(PairState<Scalar>& pairs, PairFilter filter, ParallelFor parallelFor) {
    findSweptOfPairs(pairs, parallelFor);
    const KnownPairs& known = pairs.known;
    pairs.cost.pairsWatched = known.pile->pairs.size();
    for (const PairKey key : known.pile->pairs.keys()) {
        if (!pairs.overlapNow(key) && !known.swept.touchNow(key)) {
            pairs.call.ended.push_back(key);
        }
    }
    askAboutChanged(pairs, filter);
    askInParts(pairs, filter, 1);
    takeTurned(pairs);
}

}  // namespace hashphase::detail
