// SPDX-License-Identifier: Zlib
#pragma once

// Candidates that touch on their ways.

#include <broadphase/pairs/pair_state.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::detail {

// Of what touches on its way, what may not pair is left out, but for pairs that stand. A pair that met
// on its way, and overlaps now, is kept if need be; one that is swept is not among those that are kept.
template <class Scalar>
void leaveOutSweptByGroups(PairState<Scalar>& pairs) {
    KnownPairs& known = pairs.known;
    PairCall& call = pairs.call;
    pairs.sort(call.ended);
    std::erase_if(known.swept.now, [&](PairKey key) {
        const bool isPair = !known.isRefused(key) &&
                            (known.swept.contains(key) ||
                             std::binary_search(call.ended.begin(), call.ended.end(), key));
        return !pairs.mayPairNow(key) && !isPair;
    });
    for (const PairKey key : known.swept.atUpdate) {
        pairs.keepIfPair(key);
    }
    std::sort(call.keptNow.begin(), call.keptNow.end());
    for (const PairKey key : known.kept.keys()) {
        if (known.swept.touchNow(key)) {
            call.notKept.push_back(key);
        }
    }
}

// Takes out of both lists what has ended and begun: it has touched on its way, and stands and overlaps now,
// or the other way round.
template <class Scalar>
void takeOutWhatGoesOn(PairState<Scalar>& pairs) {
    PairCall& call = pairs.call;
    pairs.sort(call.asked);
    pairs.sort(call.ended);
    call.stillEnded.clear();
    std::set_difference(call.ended.begin(), call.ended.end(), call.asked.begin(), call.asked.end(),
                        std::back_inserter(call.stillEnded));
    std::erase_if(call.stillEnded, [&](PairKey key) {
        return std::binary_search(call.keptNow.begin(), call.keptNow.end(), key);
    });
    call.stillBegun.clear();
    std::set_difference(call.asked.begin(), call.asked.end(), call.ended.begin(), call.ended.end(),
                        std::back_inserter(call.stillBegun));
    call.ended.swap(call.stillEnded);
    call.asked.swap(call.stillBegun);
}

// What is asked about so far has come to overlap.
template <class Scalar>
void findSwept(PairState<Scalar>& pairs, ParallelFor parallelFor) {
    const std::vector<PairKey>& before = pairs.known.swept.atUpdate;
    std::vector<PairKey>& now = pairs.known.swept.now;
    now.clear();
    if (pairs.sweeping != nullptr) {
        ContactSearch<Scalar>& search = pairs.sweeping->search;
        search.find(pairs.sweeping->motions.all, parallelFor);
        now.assign(search.contacts().begin(), search.contacts().end());
    }
    if (now.empty() && before.empty()) {
        return;
    }
    if (pairs.proxies.groupsOfAll() != nullptr) {
        leaveOutSweptByGroups(pairs);
    }
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(),
                        std::back_inserter(pairs.call.ended));
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                        std::back_inserter(pairs.call.asked));
    takeOutWhatGoesOn(pairs);
}

}  // namespace hashphase::detail
