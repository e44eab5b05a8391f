// SPDX-License-Identifier: Zlib
#pragma once

// How an update of pairs begins and ends; step.cpp has what lies between.

#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/memory.inl>
#include <broadphase/pairs/remembered.inl>

#include <broadphase/search/join.hpp>

namespace hashphase::detail {

template <class Scalar>
void beginSearch(PairState<Scalar>& pairs) noexcept {
    pairs.call.clear();
    if (pairs.known.pile != nullptr) {
        pairs.known.pile->turned.clear();
    }
}

template <class Scalar>
void beginCall(PairState<Scalar>& pairs) noexcept {
    beginSearch(pairs);
    if (pairs.known.pile != nullptr) {
        pairs.known.pile->sampled.clear();
        pairs.known.pile->sampledAccepted.clear();
    }
}

// Where memory has run out, everything is mobile, and what the last update has left to be watched
// are the candidates of the boxes at that time.
template <class Scalar>
void recoverPairs(PairState<Scalar>& pairs) {
    Store<Scalar>& store = pairs.store;
    KnownPairs& known = pairs.known;
    known.refused.reserve(known.refusedCount());
    pairs.lastUpdate.forget();
    store.stage(serialFor, Store<Scalar>::StageFor::repair);
    Table<Scalar>& table = pairs.lastUpdate.scratchTable();
    const ProxyGroups* const groups = pairs.proxies.groupsOfAllAtUpdate();
    table.build(pairs.proxies.mobile, pairs.store.frame.before, store.fixedSizes(), serialFor,
                groups);
    pairs.watched.amongMobile.clear();
    if (!known.arePairs()) {
        KernelCost cost;
        pairs.scratch.selected.clear();
        joinTable(table, serialFor, pairs.scratch.parts, pairs.scratch.selected, cost, groups);
        for (const auto [a, b] : pairs.scratch.selected.pairs()) {
            pairs.watched.amongMobile.push({table.order()[a], table.order()[b]});
        }
    }
    for (const PairKey key : known.refusedAtRest.keys()) {
        known.refused.findOrInsert(key);
    }
    pairs.watched.toResting.clear();
    known.refusedAtRest.clear();
    pairs.proxies.woken.clear();
    pairs.proxies.mobileAtUpdate = pairs.proxies.mobile.size();
    pairs.lastUpdate.take(LastUpdate<Scalar>::Place::ownTable);
    store.mustRebuildPairs = false;
}

template <class Scalar>
void recover(PairState<Scalar>& pairs) {
    if (pairs.store.mustRebuildPairs) {
        recoverPairs(pairs);
    }
}

template <class Scalar>
void beginUpdate(PairState<Scalar>& pairs) {
    beginCall(pairs);
    pairs.cost = {};
    releaseAfterPeak(pairs);
    recover(pairs);
    if (pairs.sweeping != nullptr) {
        pairs.sweeping->beginUpdate();
    }
    for (const PairKey key : pairs.known.kept.keys()) {
        if (pairs.known.isRefused(key) && !pairs.mayPairNow(key)) {  // filtered again
            pairs.call.notKept.push_back(key);
            pairs.call.lapsed.push_back(key);
        }
    }
}

// From now on remembers the pairs in place of what is refused; everything is mobile.
template <class Scalar>
void rememberInstead(PairState<Scalar>& pairs) {
    beginSearch(pairs);
    pairs.store.wakeAll();
    recover(pairs);
    rememberPairs(pairs);
}

// Asks about what findBegun() has found, and makes room for all that may come of the answers.
template <class Scalar>
void askAndMakeRoom(PairState<Scalar>& pairs, PairFilter filter, ParallelFor parallelFor) {
    if (!pairs.known.arePairs()) {
        askFilter(pairs, filter, parallelFor);
    }
    pairs.sort(pairs.call.ended, parallelFor);  // and so what died
    makeRoomForAnswers(pairs, pairs.updateChanges);
}

// Takes what was found for known.
template <class Scalar>
void publish(PairState<Scalar>& pairs,
             bool isFiled) noexcept {  // NOLINT(bugprone-exception-escape)
    KnownPairs& known = pairs.known;
    if (known.areAllPairs()) {
        pairs.call.died.insert(pairs.call.died.end(), pairs.call.ended.begin(),
                               pairs.call.ended.end());
        known.count -= pairs.call.ended.size();
    } else {
        for (const PairKey key : pairs.call.ended) {
            pairs.endPair(key);
            known.kept.erase(key);
        }
    }
    for (const PairKey key : pairs.call.keptNow) {
        known.kept.findOrInsert(key);
    }
    for (const PairKey key : pairs.call.notKept) {
        known.kept.erase(key);
    }
    for (const PairKey key : pairs.call.lapsed) {
        known.forgetRefused(key);
    }
    if (isFiled) {
        known.swept.advance();
        pairs.lastUpdate.take(LastUpdate<Scalar>::Place::mobileTable);
    }
    pairs.markImmediate(known.immediate.keys(), false);
    known.immediate.clear();
    pairs.fewImmediate = PairState<Scalar>::kFewImmediate;
    applyAnswers(pairs);
}

template <class Scalar>
[[nodiscard]] PairChanges endUpdate(PairState<Scalar>& pairs, ParallelFor parallelFor) noexcept {
    chooseSide(pairs, true);
    return report(pairs, pairs.updateChanges, parallelFor);
}

}  // namespace hashphase::detail
