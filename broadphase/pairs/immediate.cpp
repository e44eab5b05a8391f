// SPDX-License-Identifier: Zlib

// What Pairs tells between updates: of one proxy, at once.

#include <broadphase/pairs/pair_tracker.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::detail {
template <class Scalar>
template <class Find>
PairChanges PairTracker<Scalar>::findNow(PairFilter filter, const Find& find) {
    beginCall();
    findImmediateOfRemoved();
    find();
    return applyFilterNow(filter);
}

template <class Scalar>
PairChanges PairTracker<Scalar>::findPairsNow(std::uint32_t proxyIndex, PairFilter filter) {
    return findNow(filter, [&] { findNewCandidates(proxyIndex); });
}

template <class Scalar>
PairChanges PairTracker<Scalar>::findPairsNow(std::uint32_t proxyIndex,
                                              std::span<const ProxyId> others, PairFilter filter) {
    return findNow(filter, [&] {
        for (const ProxyId other : others) {
            if (other.index != proxyIndex && proxies_.contains(other)) {
                addIfNew(proxyIndex, other.index);
            }
        }
    });
}

// Of a large part of all proxies, all candidates are found in one pass.
template <class Scalar>
PairChanges PairTracker<Scalar>::refilter(std::span<const ProxyId> ids, PairFilter filter) {
    beginRefilter();
    constexpr std::size_t kLargePart = 8;
    if (ids.size() > 1 && ids.size() > proxies_.size / kLargePart) {
        isNamed_.assign(proxies_.records.size(), 0);
        for (const ProxyId id : ids) {
            if (proxies_.contains(id)) {
                isNamed_[id.index] = 1;
            }
        }
        askAgainAboutMany(filter,
                          [this](std::uint32_t proxyIndex) { return isNamed_[proxyIndex] != 0; });
    } else {
        askAgainAboutFew(ids, filter);
    }
    return applyFilterNow(filter);
}

// Where they are asked about in parts, those with a proxy that has been dealt with are left out.
template <class Scalar>
void PairTracker<Scalar>::askAgainAboutFew(std::span<const ProxyId> ids, PairFilter filter) {
    isNamed_.assign(remembersPairs() ? proxies_.records.size() : 0, 0);
    const auto isDone = [this](std::uint32_t proxyIndex) {
        return proxyIndex < isNamed_.size() && isNamed_[proxyIndex] != 0;
    };
    for (const ProxyId id : ids) {
        if (!proxies_.contains(id) || isDone(id.index)) {
            continue;
        }
        if (store_.cost.changed > 0) {
            findNewCandidates(id.index, [&](std::uint32_t other) {
                return !(isDone(other) && wouldFind(other, id.index));
            });
        }
        forKnownPairs(id.index, [&](PairKey c) {
            if (!isDone(first(c)) && !isDone(second(c))) {
                askAgain(c);
            }
        });
        askInParts(filter, kPart);
        if (!isNamed_.empty()) {
            isNamed_[id.index] = 1;
        }
    }
}

template <class Scalar>
void PairTracker<Scalar>::beginRefilter() {
    beginCall();
    recover();
    findImmediateOfRemoved();
}

template <class Scalar>
PairChanges PairTracker<Scalar>::refilter(std::span<const ProxyPair> pairs, PairFilter filter) {
    beginRefilter();
    for (const ProxyPair& pair : pairs) {
        if (isPair(pair)) {
            askAgain(pairKey(pair.first.index, pair.second.index));
        }
    }
    return applyFilterNow(filter);
}

template <class Scalar>
bool PairTracker<Scalar>::isPair(const ProxyPair& pair) const noexcept {
    const auto [a, b] = pair;
    if (a == b || !proxies_.contains(a) || !proxies_.contains(b)) {
        return false;
    }
    const PairKey c = pairKey(a.index, b.index);
    return !isRefused(c) && (wasKnown(a.index, b.index) || immediate_.contains(c) || isSwept(c));
}

template <class Scalar>
PairChanges PairTracker<Scalar>::refilterAll(PairFilter filter) {
    beginRefilter();
    askAgainAboutMany(filter, [](std::uint32_t) { return true; });
    return applyFilterNow(filter);
}

// What is not known yet is of one that has changed.
template <class Scalar>
template <class IsNamed>
void PairTracker<Scalar>::askAgainAboutMany(PairFilter filter, const IsNamed& isNamed) {
    if (store_.cost.changed > 0) {
        for (const std::uint32_t proxyIndex : proxies_.mobile) {
            if (proxies_.changedNow(proxyIndex) && proxies_.isAlive(proxyIndex)) {
                findNewCandidates(proxyIndex, [&](std::uint32_t other) {
                    const bool isFoundByOther = other < proxyIndex && proxies_.changedNow(other) &&
                                                wouldFind(other, proxyIndex);
                    return (isNamed(proxyIndex) || isNamed(other)) && !isFoundByOther;
                });
                askInParts(filter, kPart);
            }
        }
    }
    forAllKnown([&](PairKey c) {
        if (isNamed(first(c)) || isNamed(second(c))) {
            askAgain(c);
            askInParts(filter, kPart);
        }
    });
}

// Whether findNewCandidates() of one comes upon the other, which it looks for by its box in the grid.
template <class Scalar>
bool PairTracker<Scalar>::wouldFind(std::uint32_t finder, std::uint32_t found) const {
    return overlaps(boxAtStart(finder), proxies_.records[found].box);
}

// Asks about a candidate that is known. One that is refused and apart for the moment is asked about by
// update(), should they meet again.
template <class Scalar>
void PairTracker<Scalar>::askAgain(PairKey c) {
    if (!proxies_.isAlive(first(c)) || !proxies_.isAlive(second(c))) {
        return;
    }
    if (!isRefused(c)) {
        acceptedPairs_.push_back(c);
        asked_.push_back(c);
    } else if (isSwept(c) || touchAtStart(first(c), second(c))) {
        asked_.push_back(c);
    }
}

// A candidate may have been found from either of the two.
template <class Scalar>
PairChanges PairTracker<Scalar>::applyFilterNow(PairFilter filter) {
    if (remembersPairs()) {
        askInParts(filter, 1);
        takeTurned();
        newCandidates_.clear();
        std::copy_if(asked_.begin(), asked_.end(), std::back_inserter(newCandidates_),
                     [this](PairKey c) {
                         return isRefused(c) && !wasKnown(first(c), second(c)) && !isSwept(c);
                     });
    } else {
        for (std::vector<PairKey>* candidates : {&asked_, &acceptedPairs_, &newCandidates_}) {
            sortPairs(*candidates);
            candidates->erase(std::unique(candidates->begin(), candidates->end()),
                              candidates->end());
        }
        ask(filter);
    }
    makeRoom(immediateChanges_);
    endImmediateOfRemoved();
    noteNewCandidates();
    applyFilter();
    chooseSide(false);
    return report(immediateChanges_);
}

template <class Scalar>
void PairTracker<Scalar>::noteNewCandidates() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const PairKey c : newCandidates_) {
        immediate_.insert(c);
    }
    markImmediate(newCandidates_, true);
}

// The grid keeps the indices of those that are removed apart, until their candidates are ended.
template <class Scalar>
void PairTracker<Scalar>::markImmediate(std::span<const PairKey> candidates, bool are) noexcept {
    for (const PairKey c : candidates) {
        proxies_.records[first(c)].isImmediate = are;
        proxies_.records[second(c)].isImmediate = are;
    }
}

// Where proxies come, their pairs are found at once, they go, and no update follows: whenever twice as many
// candidates are immediate as were left the last time, so that each is looked at about once.
template <class Scalar>
bool PairTracker<Scalar>::areManyImmediate() const noexcept {
    return immediate_.size() > fewImmediate_ && proxies_.removedImmediate.count > 0;
}

template <class Scalar>
void PairTracker<Scalar>::findImmediateOfRemoved() {
    if (!areManyImmediate()) {
        return;
    }
    stillImmediate_.clear();
    for (const PairKey c : immediate_.keys()) {
        const bool areAlive = proxies_.isAlive(first(c)) && proxies_.isAlive(second(c));
        (areAlive ? stillImmediate_ : endedPairs_).push_back(c);
    }
}

template <class Scalar>
void PairTracker<Scalar>::endImmediateOfRemoved() noexcept {
    if (!areManyImmediate()) {
        return;
    }
    markImmediate(immediate_.keys(), false);
    immediate_.clear();
    for (const PairKey c : stillImmediate_) {
        immediate_.insert(c);
    }
    markImmediate(immediate_.keys(), true);
    for (const PairKey c : endedPairs_) {
        endPair(c);
    }
    fewImmediate_ = kFewImmediate + 2 * immediate_.size();
    proxies_.giveBack(proxies_.removedImmediate);
}

template PairChanges PairTracker<float>::findPairsNow(std::uint32_t, PairFilter);
template PairChanges PairTracker<float>::findPairsNow(std::uint32_t, std::span<const ProxyId>,
                                                      PairFilter);
template PairChanges PairTracker<float>::refilter(std::span<const ProxyId>, PairFilter);
template PairChanges PairTracker<float>::refilter(std::span<const ProxyPair>, PairFilter);
template void PairTracker<float>::askAgainAboutFew(std::span<const ProxyId>, PairFilter);
template void PairTracker<float>::beginRefilter();
template bool PairTracker<float>::isPair(const ProxyPair&) const noexcept;
template PairChanges PairTracker<float>::refilterAll(PairFilter);
template bool PairTracker<float>::wouldFind(std::uint32_t, std::uint32_t) const;
template void PairTracker<float>::askAgain(PairKey);
template PairChanges PairTracker<float>::applyFilterNow(PairFilter);
template void PairTracker<float>::noteNewCandidates() noexcept;
template void PairTracker<float>::markImmediate(std::span<const PairKey>, bool) noexcept;
template bool PairTracker<float>::areManyImmediate() const noexcept;
template void PairTracker<float>::findImmediateOfRemoved();
template void PairTracker<float>::endImmediateOfRemoved() noexcept;
template PairChanges PairTracker<double>::findPairsNow(std::uint32_t, PairFilter);
template PairChanges PairTracker<double>::findPairsNow(std::uint32_t, std::span<const ProxyId>,
                                                       PairFilter);
template PairChanges PairTracker<double>::refilter(std::span<const ProxyId>, PairFilter);
template PairChanges PairTracker<double>::refilter(std::span<const ProxyPair>, PairFilter);
template void PairTracker<double>::askAgainAboutFew(std::span<const ProxyId>, PairFilter);
template void PairTracker<double>::beginRefilter();
template bool PairTracker<double>::isPair(const ProxyPair&) const noexcept;
template PairChanges PairTracker<double>::refilterAll(PairFilter);
template bool PairTracker<double>::wouldFind(std::uint32_t, std::uint32_t) const;
template void PairTracker<double>::askAgain(PairKey);
template PairChanges PairTracker<double>::applyFilterNow(PairFilter);
template void PairTracker<double>::noteNewCandidates() noexcept;
template void PairTracker<double>::markImmediate(std::span<const PairKey>, bool) noexcept;
template bool PairTracker<double>::areManyImmediate() const noexcept;
template void PairTracker<double>::findImmediateOfRemoved();
template void PairTracker<double>::endImmediateOfRemoved() noexcept;

}  // namespace hashphase::detail
