// SPDX-License-Identifier: Zlib

// What Pairs tells between updates: of one proxy, at once.

#include <broadphase/pairs/pair_tracker.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::detail {
template <class Scalar>
template <class Find>
PairChanges PairTracker<Scalar>::announceFound(PairFilter filter, const Find& find) {
    beginCall();
    findAnnouncedOfRemoved();
    find();
    return decideBetween(filter);
}

template <class Scalar>
PairChanges PairTracker<Scalar>::announce(std::uint32_t slot, PairFilter filter) {
    return announceFound(filter, [&] { findUnknown(slot); });
}

template <class Scalar>
PairChanges PairTracker<Scalar>::announce(std::uint32_t slot, std::span<const ProxyId> others,
                                          PairFilter filter) {
    return announceFound(filter, [&] {
        for (const ProxyId other : others) {
            if (other.index != slot && store_.proxies.contains(other)) {
                addIfUnknown(slot, other.index);
            }
        }
    });
}

// Of a large part of all proxies, all couples are found in one pass.
template <class Scalar>
PairChanges PairTracker<Scalar>::refilter(std::span<const ProxyId> ids, PairFilter filter) {
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    constexpr std::size_t kLargePart = 8;
    if (ids.size() > 1 && ids.size() > store_.proxies.size / kLargePart) {
        isNamed_.assign(store_.proxies.records.size(), 0);
        for (const ProxyId id : ids) {
            if (store_.proxies.contains(id)) {
                isNamed_[id.index] = 1;
            }
        }
        askAgainAboutMany(filter, [this](std::uint32_t slot) { return isNamed_[slot] != 0; });
        return decideBetween(filter);
    }
    // Where they are asked about in parts, those with a proxy that has been dealt with are left out.
    isNamed_.assign(remembersPairs() ? store_.proxies.records.size() : 0, 0);
    const auto isDone = [this](std::uint32_t slot) {
        return slot < isNamed_.size() && isNamed_[slot] != 0;
    };
    for (const ProxyId id : ids) {
        if (!store_.proxies.contains(id) || isDone(id.index)) {
            continue;
        }
        if (store_.cost.changed > 0) {
            findUnknown(id.index, [&](std::uint32_t other) {
                return !(isDone(other) && wouldFind(other, id.index));
            });
        }
        forKnownCouples(id.index, [&](Couple c) {
            if (!isDone(first(c)) && !isDone(second(c))) {
                askAgain(c);
            }
        });
        askInParts(filter, kPart);
        if (!isNamed_.empty()) {
            isNamed_[id.index] = 1;
        }
    }
    return decideBetween(filter);
}

template <class Scalar>
PairChanges PairTracker<Scalar>::refilter(std::span<const ProxyPair> pairs, PairFilter filter) {
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    for (const ProxyPair& pair : pairs) {
        if (isPair(pair)) {
            askAgain(couple(pair.first.index, pair.second.index));
        }
    }
    return decideBetween(filter);
}

template <class Scalar>
bool PairTracker<Scalar>::isPair(const ProxyPair& pair) const noexcept {
    const auto [a, b] = pair;
    if (a == b || !store_.proxies.contains(a) || !store_.proxies.contains(b)) {
        return false;
    }
    const Couple c = couple(a.index, b.index);
    return !isRefused(c) && (wasKnown(a.index, b.index) || announced_.contains(c) || isSwept(c));
}

template <class Scalar>
PairChanges PairTracker<Scalar>::refilterAll(PairFilter filter) {
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    askAgainAboutMany(filter, [](std::uint32_t) { return true; });
    return decideBetween(filter);
}

// What is not known yet is of one that has changed.
template <class Scalar>
template <class IsNamed>
void PairTracker<Scalar>::askAgainAboutMany(PairFilter filter, const IsNamed& isNamed) {
    if (store_.cost.changed > 0) {
        for (const std::uint32_t slot : store_.proxies.mobile) {
            if (store_.proxies.changedNow(slot) && store_.proxies.isAlive(slot)) {
                findUnknown(slot, [&](std::uint32_t other) {
                    const bool isFoundByOther =
                        other < slot && store_.proxies.changedNow(other) && wouldFind(other, slot);
                    return (isNamed(slot) || isNamed(other)) && !isFoundByOther;
                });
                askInParts(filter, kPart);
            }
        }
    }
    forAllKnown([&](Couple c) {
        if (isNamed(first(c)) || isNamed(second(c))) {
            askAgain(c);
            askInParts(filter, kPart);
        }
    });
}

// Whether findUnknown() of one comes upon the other, which it looks for by its box in the grid.
template <class Scalar>
bool PairTracker<Scalar>::wouldFind(std::uint32_t finder, std::uint32_t found) const {
    return overlaps(boxAtStart(finder), store_.proxies.records[found].box);
}

// Asks about a couple that is known. One that is refused and apart for the moment is asked about by
// update(), should they meet again.
template <class Scalar>
void PairTracker<Scalar>::askAgain(Couple c) {
    if (!store_.proxies.isAlive(first(c)) || !store_.proxies.isAlive(second(c))) {
        return;
    }
    if (!isRefused(c)) {
        standing_.push_back(c);
        asked_.push_back(c);
    } else if (isSwept(c) || touchAtStart(first(c), second(c))) {
        asked_.push_back(c);
    }
}

// A couple may have been found from either of the two.
template <class Scalar>
PairChanges PairTracker<Scalar>::decideBetween(PairFilter filter) {
    if (remembersPairs()) {
        askInParts(filter, 1);
        takeTurned();
        unknown_.clear();
        std::copy_if(asked_.begin(), asked_.end(), std::back_inserter(unknown_), [this](Couple c) {
            return isRefused(c) && !wasKnown(first(c), second(c)) && !isSwept(c);
        });
    } else {
        for (std::vector<Couple>* couples : {&asked_, &standing_, &unknown_}) {
            sortCouples(*couples);
            couples->erase(std::unique(couples->begin(), couples->end()), couples->end());
        }
        ask(filter);
    }
    makeRoom(toldBetween_);
    endAnnouncedOfRemoved();
    announceUnknown();
    decide();
    chooseSide(false);
    return tell(toldBetween_);
}

template <class Scalar>
void PairTracker<Scalar>::announceUnknown() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const Couple c : unknown_) {
        announced_.insert(c);
    }
    markAnnounced(unknown_, true);
}

// The grid keeps the slots of those that are removed apart, until their couples are ended.
template <class Scalar>
void PairTracker<Scalar>::markAnnounced(std::span<const Couple> couples, bool are) noexcept {
    for (const Couple c : couples) {
        store_.proxies.records[first(c)].isAnnounced = are;
        store_.proxies.records[second(c)].isAnnounced = are;
    }
}

// Where proxies come, are announced and go, and there is no update: whenever twice as many couples are
// announced as were left the last time, so that each is looked at about once.
template <class Scalar>
bool PairTracker<Scalar>::areManyAnnounced() const noexcept {
    return announced_.size() > fewAnnounced_ && store_.proxies.removedAnnounced.count > 0;
}

template <class Scalar>
void PairTracker<Scalar>::findAnnouncedOfRemoved() {
    if (!areManyAnnounced()) {
        return;
    }
    stillAnnounced_.clear();
    for (const Couple c : announced_.keys()) {
        const bool areAlive = store_.proxies.isAlive(first(c)) && store_.proxies.isAlive(second(c));
        (areAlive ? stillAnnounced_ : lost_).push_back(c);
    }
}

template <class Scalar>
void PairTracker<Scalar>::endAnnouncedOfRemoved() noexcept {
    if (!areManyAnnounced()) {
        return;
    }
    markAnnounced(announced_.keys(), false);
    announced_.clear();
    for (const Couple c : stillAnnounced_) {
        announced_.insert(c);
    }
    markAnnounced(announced_.keys(), true);
    for (const Couple c : lost_) {
        lose(c);
    }
    fewAnnounced_ = kFewAnnounced + 2 * announced_.size();
    store_.proxies.giveBack(store_.proxies.removedAnnounced);
}

template PairChanges PairTracker<float>::announce(std::uint32_t, PairFilter);
template PairChanges PairTracker<float>::announce(std::uint32_t, std::span<const ProxyId>,
                                                  PairFilter);
template PairChanges PairTracker<float>::refilter(std::span<const ProxyId>, PairFilter);
template PairChanges PairTracker<float>::refilter(std::span<const ProxyPair>, PairFilter);
template bool PairTracker<float>::isPair(const ProxyPair&) const noexcept;
template PairChanges PairTracker<float>::refilterAll(PairFilter);
template bool PairTracker<float>::wouldFind(std::uint32_t, std::uint32_t) const;
template void PairTracker<float>::askAgain(Couple);
template PairChanges PairTracker<float>::decideBetween(PairFilter);
template void PairTracker<float>::announceUnknown() noexcept;
template void PairTracker<float>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool PairTracker<float>::areManyAnnounced() const noexcept;
template void PairTracker<float>::findAnnouncedOfRemoved();
template void PairTracker<float>::endAnnouncedOfRemoved() noexcept;
template PairChanges PairTracker<double>::announce(std::uint32_t, PairFilter);
template PairChanges PairTracker<double>::announce(std::uint32_t, std::span<const ProxyId>,
                                                   PairFilter);
template PairChanges PairTracker<double>::refilter(std::span<const ProxyId>, PairFilter);
template PairChanges PairTracker<double>::refilter(std::span<const ProxyPair>, PairFilter);
template bool PairTracker<double>::isPair(const ProxyPair&) const noexcept;
template PairChanges PairTracker<double>::refilterAll(PairFilter);
template bool PairTracker<double>::wouldFind(std::uint32_t, std::uint32_t) const;
template void PairTracker<double>::askAgain(Couple);
template PairChanges PairTracker<double>::decideBetween(PairFilter);
template void PairTracker<double>::announceUnknown() noexcept;
template void PairTracker<double>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool PairTracker<double>::areManyAnnounced() const noexcept;
template void PairTracker<double>::findAnnouncedOfRemoved();
template void PairTracker<double>::endAnnouncedOfRemoved() noexcept;

}  // namespace hashphase::detail
