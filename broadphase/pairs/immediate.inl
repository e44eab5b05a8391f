// SPDX-License-Identifier: Zlib
#pragma once

// What Pairs report between updates: of one proxy, or of what the filter is to be asked about again, at once.

#include <broadphase/pairs/candidates.inl>
#include <broadphase/pairs/filter.inl>
#include <broadphase/pairs/remembered.inl>
#include <broadphase/pairs/update.inl>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

namespace hashphase::detail {

// Where proxies come, their pairs are found at once, they go, and no update follows: whenever twice as many
// candidates are immediate as were left the last time, so that each is looked at about once.
template <class Scalar>
[[nodiscard]] bool areManyImmediate(const PairState<Scalar>& pairs) noexcept {
    return pairs.known.immediate.size() > pairs.fewImmediate &&
           pairs.proxies.removedImmediate.count > 0;
}

template <class Scalar>
void findImmediateOfRemoved(PairState<Scalar>& pairs) {
    if (!areManyImmediate(pairs)) {
        return;
    }
    pairs.call.setAside.clear();
    for (const PairKey key : pairs.known.immediate.keys()) {
        (pairs.areAlive(key) ? pairs.call.setAside : pairs.call.ended).push_back(key);
    }
}

template <class Scalar>
void endImmediateOfRemoved(PairState<Scalar>& pairs) noexcept {
    if (!areManyImmediate(pairs)) {
        return;
    }
    PairKeySet& immediate = pairs.known.immediate;
    pairs.markImmediate(immediate.keys(), false);
    immediate.clear();
    for (const PairKey key : pairs.call.setAside) {
        immediate.insert(key);
    }
    pairs.markImmediate(immediate.keys(), true);
    for (const PairKey key : pairs.call.ended) {
        pairs.endPair(key);
    }
    pairs.fewImmediate = static_cast<std::uint32_t>(
        std::min<std::size_t>(PairState<Scalar>::kFewImmediate + 2 * immediate.size(),
                              std::numeric_limits<std::uint32_t>::max()));
    pairs.proxies.giveBack(pairs.proxies.removedImmediate);
}

// Asks what the call has not asked in parts. A candidate may have been found from either of the two.
template <class Scalar>
void askWhatIsLeft(PairState<Scalar>& pairs, PairFilter filter) {
    PairCall& call = pairs.call;
    if (!pairs.known.arePairs()) {
        for (std::vector<PairKey>* keys : {&call.asked, &call.standing, &call.immediate}) {
            pairs.sortAndUnite(*keys);
        }
        askFilter(pairs, filter);
        return;
    }
    askInParts(pairs, filter, 1);
    takeTurned(pairs);
    call.immediate.clear();
    std::copy_if(call.asked.begin(), call.asked.end(), std::back_inserter(call.immediate),
                 [&](PairKey key) {
                     return pairs.known.isRefused(key) && !pairs.wasCandidate(key) &&
                            !pairs.known.swept.contains(key);
                 });
}

template <class Scalar>
[[nodiscard]] PairChanges endCall(PairState<Scalar>& pairs, PairFilter filter) {
    askWhatIsLeft(pairs, filter);
    makeRoomForAnswers(pairs, pairs.immediateChanges);
    // From here on nothing throws.
    endImmediateOfRemoved(pairs);
    for (const PairKey key : pairs.call.immediate) {
        pairs.known.immediate.insert(key);
    }
    pairs.markImmediate(pairs.call.immediate, true);
    applyAnswers(pairs);
    chooseSide(pairs, false);
    return report(pairs, pairs.immediateChanges);
}

// --- New pairs -----------------------------------------------------------------------------------

template <class Scalar>
[[nodiscard]] PairChanges findPairsNow(PairState<Scalar>& pairs, std::uint32_t proxyIndex,
                                       PairFilter filter) {
    beginCall(pairs);
    findImmediateOfRemoved(pairs);
    listStrays(pairs);
    findNewCandidates(pairs, proxyIndex, [](std::uint32_t) { return true; });
    return endCall(pairs, filter);
}

template <class Scalar>
[[nodiscard]] PairChanges findPairsNow(PairState<Scalar>& pairs, std::uint32_t proxyIndex,
                                       std::span<const ProxyId> others, PairFilter filter) {
    beginCall(pairs);
    findImmediateOfRemoved(pairs);
    for (const ProxyId other : others) {
        if (other.index != proxyIndex && pairs.proxies.contains(other)) {
            listIfNew(pairs, pairKey(proxyIndex, other.index));
        }
    }
    return endCall(pairs, filter);
}

// --- The filter again ----------------------------------------------------------------------------

template <class Scalar>
void beginRefilter(PairState<Scalar>& pairs) {
    beginCall(pairs);
    recover(pairs);
    findImmediateOfRemoved(pairs);
}

// Asks about a candidate that is known. One that is refused and apart for the moment is asked about by
// an update, should they meet again.
template <class Scalar>
void listAgain(PairState<Scalar>& pairs, PairKey key) {
    if (!pairs.areAlive(key)) {
        return;
    }
    if (!pairs.known.isRefused(key)) {
        pairs.call.standing.push_back(key);
        pairs.listToAsk(key);
    } else if (pairs.known.swept.contains(key) || pairs.touchAtStart(key)) {
        pairs.listToAsk(key);
    }
}

// Where they are asked about in parts, those with a proxy that has been dealt with are left out.
template <class Scalar>
void askAgainAboutFew(PairState<Scalar>& pairs, std::span<const ProxyId> ids, PairFilter filter) {
    std::vector<char>& isNamed = pairs.scratch.isNamed;
    isNamed.assign(pairs.known.arePairs() ? pairs.proxies.records.size() : 0, 0);
    const auto isDone = [&](std::uint32_t proxyIndex) {
        return proxyIndex < isNamed.size() && isNamed[proxyIndex] != 0;
    };
    listStrays(pairs);
    for (const ProxyId id : ids) {
        if (!pairs.proxies.contains(id) || isDone(id.index)) {
            continue;
        }
        if (pairs.store.cost.changed > 0) {
            findNewCandidates(pairs, id.index, [&](std::uint32_t other) { return !isDone(other); });
        }
        forEachKnown(pairs, id.index, [&](PairKey key) {
            if (!isDone(firstIndex(key)) && !isDone(secondIndex(key))) {
                listAgain(pairs, key);
            }
        });
        askInParts(pairs, filter, PairState<Scalar>::kPart);
        if (!isNamed.empty()) {
            isNamed[id.index] = 1;
        }
    }
}

// What is not known yet is of one that has changed. Those that rest, and have moved within their slack, are in the
// list of changes.
template <class Scalar, class IsNamed>
void askAgainAboutMany(PairState<Scalar>& pairs, PairFilter filter, const IsNamed& isNamed) {
    const Population<Scalar>& proxies = pairs.proxies;
    constexpr std::size_t kPart = PairState<Scalar>::kPart;
    const auto askIfChanged = [&](std::uint32_t proxyIndex) {
        if (!proxies.changedNow(proxyIndex) || !proxies.isAlive(proxyIndex)) {
            return;
        }
        findNewCandidates(pairs, proxyIndex, [&](std::uint32_t other) {
            const bool isFoundByOther = other < proxyIndex && proxies.changedNow(other);
            return (isNamed(proxyIndex) || isNamed(other)) && !isFoundByOther;
        });
        askInParts(pairs, filter, kPart);
    };
    if (pairs.store.cost.changed > 0) {
        listStrays(pairs);
        std::ranges::for_each(proxies.mobile, askIfChanged);
        for (const std::uint32_t proxyIndex : proxies.waiting) {
            if (proxies.rests(proxyIndex)) {
                askIfChanged(proxyIndex);
            }
        }
    }
    pairs.store.mendTables();  // or a query of the filter would, while they are read
    forEachKnown(pairs, [&](PairKey key) {
        if (isNamed(firstIndex(key)) || isNamed(secondIndex(key))) {
            listAgain(pairs, key);
            askInParts(pairs, filter, kPart);
        }
    });
}

// Of a large part of all proxies, all candidates are found in one pass.
template <class Scalar>
[[nodiscard]] PairChanges refilter(PairState<Scalar>& pairs, std::span<const ProxyId> ids,
                                   PairFilter filter) {
    beginRefilter(pairs);
    constexpr std::size_t kLargePart = 8;
    if (ids.size() > 1 && ids.size() > pairs.proxies.size / kLargePart) {
        std::vector<char>& isNamed = pairs.scratch.isNamed;
        isNamed.assign(pairs.proxies.records.size(), 0);
        for (const ProxyId id : ids) {
            if (pairs.proxies.contains(id)) {
                isNamed[id.index] = 1;
            }
        }
        askAgainAboutMany(pairs, filter,
                          [&](std::uint32_t proxyIndex) { return isNamed[proxyIndex] != 0; });
    } else {
        askAgainAboutFew(pairs, ids, filter);
    }
    return endCall(pairs, filter);
}

template <class Scalar>
[[nodiscard]] bool isPair(const PairState<Scalar>& pairs, const ProxyPair& pair) noexcept {
    const auto [a, b] = pair;
    if (a == b || !pairs.proxies.contains(a) || !pairs.proxies.contains(b)) {
        return false;
    }
    const PairKey key = pairKey(a.index, b.index);
    return !pairs.known.isRefused(key) && pairs.isKnown(key);
}

template <class Scalar>
[[nodiscard]] PairChanges refilter(PairState<Scalar>& pairs, std::span<const ProxyPair> some,
                                   PairFilter filter) {
    beginRefilter(pairs);
    for (const ProxyPair& pair : some) {
        if (isPair(pairs, pair)) {
            listAgain(pairs, pairKey(pair.first.index, pair.second.index));
        }
    }
    return endCall(pairs, filter);
}

template <class Scalar>
[[nodiscard]] PairChanges refilterAll(PairState<Scalar>& pairs, PairFilter filter) {
    beginRefilter(pairs);
    askAgainAboutMany(pairs, filter, [](std::uint32_t) { return true; });
    return endCall(pairs, filter);
}

}  // namespace hashphase::detail
