// SPDX-License-Identifier: Zlib
#pragma once

// What Pairs hold, and what they give back after a peak.

#include <broadphase/pairs/pair_state.hpp>

#include <broadphase/core/caught.hpp>

namespace hashphase::detail {

template <class Scalar>
[[nodiscard]] std::size_t memoryBytes(const PairState<Scalar>& pairs) noexcept {
    return sizeof(pairs) + pairs.watched.memoryBytes() + pairs.known.memoryBytes() +
           pairs.lastUpdate.memoryBytes() + pairs.call.memoryBytes() +
           pairs.updateChanges.memoryBytes() + pairs.immediateChanges.memoryBytes() +
           pairs.scratch.memoryBytes();
}

template <class Scalar>
void releaseUnusedMemory(PairState<Scalar>& pairs) noexcept {
    // What is found again by each call.
    pairs.call.releaseMemory();
    freeArrays(pairs.updateChanges.born, pairs.updateChanges.died, pairs.immediateChanges.born,
               pairs.immediateChanges.died);
    pairs.scratch = {};
    pairs.watched.carried = {};
    if (!pairs.tables.resting.isSettled()) {
        pairs.watched.settled.reset();
    }
    pairs.lastUpdate.releaseMemory();
    // What is kept.
    KnownPairs& known = pairs.known;
    freeArrays(known.swept.now, known.swept.bySecond);
    known.swept.atUpdate.shrink_to_fit();
    if (!known.arePairs()) {
        known.pile.reset();
    }
    // Where there is no memory to move it to, it is kept as it is.
    static_cast<void>(hasRoomFor([&] {
        pairs.watched.amongMobile.shrink();
        pairs.watched.toResting.shrink();
        for (FlatSet* keys : {&known.refused, &known.refusedAtRest, &known.kept}) {
            keys->shrink();
        }
        known.immediate.shrink();
        if (known.ignored != nullptr) {
            known.ignored->shrink([&](const ProxyPair& pair) { return !pairs.areAlive(pair); });
        }
        if (known.pile != nullptr) {
            freeArrays(known.pile->turned, known.pile->sampledAccepted);
            known.pile->sampled = {};
            known.pile->pairs.shrink();
        }
    }));
}

template <class Scalar>
void releaseAfterPeak(PairState<Scalar>& pairs) noexcept {
    const KnownPairs& known = pairs.known;
    const WatchedPairs& watched = pairs.watched;
    // Searches make room for some candidates of each mobile proxy.
    const std::size_t count = pairs.proxies.mobile.size() + watched.amongMobile.size() +
                              watched.toResting.size() + known.size();
    const std::size_t room =
        watched.amongMobile.capacity() + watched.toResting.capacity() + known.capacity();
    if (pairs.peaks.isPast(count, room)) {
        releaseUnusedMemory(pairs);
    }
}

}  // namespace hashphase::detail
