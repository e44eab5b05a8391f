// SPDX-License-Identifier: Zlib

// What Pairs tells between updates: of one proxy, at once.

#include <broadphase/pairs.hpp>

#include <broadphase/sweeps.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase {
namespace {

[[maybe_unused]] constexpr const char* kMustNotAsk =
    "Pairs are not announced, nor filtered again, from within the filter.";

}  // namespace

template <class Scalar>
template <class Find>
PairChanges Pairs<Scalar>::announceFound(ProxyId id, PairFilter filter, const Find& find) {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can announce its pairs.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    if (!grid_.contains(id)) {
        return {};
    }
    beginCall();
    findAnnouncedOfRemoved();
    find(id.index);
    return decideBetween(filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::announce(ProxyId id, PairFilter filter) & {
    return announceFound(id, filter, [this](std::uint32_t slot) { findUnknown(slot); });
}

template <class Scalar>
PairChanges Pairs<Scalar>::announce(ProxyId id, std::span<const ProxyId> others,
                                    PairFilter filter) & {
    return announceFound(id, filter, [&](std::uint32_t slot) {
        for (const ProxyId other : others) {
            if (other != id && grid_.contains(other)) {
                addIfUnknown(slot, other.index);
            }
        }
    });
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(ProxyId id, PairFilter filter) & {
    return refilter(std::span(&id, 1), filter);
}

// Of a large part of all proxies, all couples are found in one pass.
template <class Scalar>
PairChanges Pairs<Scalar>::refilter(std::span<const ProxyId> ids, PairFilter filter) & {
    for ([[maybe_unused]] const ProxyId id : ids) {
        HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can be filtered again.");
    }
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    constexpr std::size_t kLargePart = 8;
    if (ids.size() > 1 && ids.size() > grid_.size() / kLargePart) {
        isNamed_.assign(grid_.records_.size(), 0);
        for (const ProxyId id : ids) {
            if (grid_.contains(id)) {
                isNamed_[id.index] = 1;
            }
        }
        askAgainAboutMany(filter, [this](std::uint32_t slot) { return isNamed_[slot] != 0; });
        return decideBetween(filter);
    }
    // Where they are asked about in parts, those with a proxy that has been dealt with are left out.
    isNamed_.assign(remembersPairs() ? grid_.records_.size() : 0, 0);
    const auto isDone = [this](std::uint32_t slot) {
        return slot < isNamed_.size() && isNamed_[slot] != 0;
    };
    for (const ProxyId id : ids) {
        if (!grid_.contains(id) || isDone(id.index)) {
            continue;
        }
        if (grid_.cost_.changed > 0) {
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
PairChanges Pairs<Scalar>::refilter(std::span<const ProxyPair> pairs, PairFilter filter) & {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
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
bool Pairs<Scalar>::isPair(const ProxyPair& pair) const noexcept {
    const auto [a, b] = pair;
    if (a == b || !grid_.contains(a) || !grid_.contains(b)) {
        return false;
    }
    const Couple c = couple(a.index, b.index);
    return !isRefused(c) && (wasKnown(a.index, b.index) || announced_.contains(c) || isSwept(c));
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilterAll(PairFilter filter) & {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    askAgainAboutMany(filter, [](std::uint32_t) { return true; });
    return decideBetween(filter);
}

// What is not known yet is of one that has changed.
template <class Scalar>
template <class IsNamed>
void Pairs<Scalar>::askAgainAboutMany(PairFilter filter, const IsNamed& isNamed) {
    if (grid_.cost_.changed > 0) {
        for (const std::uint32_t slot : grid_.mobileSlots_) {
            if (grid_.changedNow(slot) && grid_.isAlive(slot)) {
                findUnknown(slot, [&](std::uint32_t other) {
                    const bool isFoundByOther =
                        other < slot && grid_.changedNow(other) && wouldFind(other, slot);
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
bool Pairs<Scalar>::wouldFind(std::uint32_t finder, std::uint32_t found) const {
    return overlaps(boxAtStart(finder), grid_.records_[found].box);
}

// Asks about a couple that is known. One that is refused and apart for the moment is asked about by
// update(), should they meet again.
template <class Scalar>
void Pairs<Scalar>::askAgain(Couple c) {
    if (!grid_.isAlive(first(c)) || !grid_.isAlive(second(c))) {
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
PairChanges Pairs<Scalar>::decideBetween(PairFilter filter) {
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
void Pairs<Scalar>::announceUnknown() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const Couple c : unknown_) {
        announced_.insert(c);
    }
    markAnnounced(unknown_, true);
}

// The grid keeps the slots of those that are removed apart, until their couples are ended.
template <class Scalar>
void Pairs<Scalar>::markAnnounced(std::span<const Couple> couples, bool are) noexcept {
    for (const Couple c : couples) {
        grid_.records_[first(c)].isAnnounced = are;
        grid_.records_[second(c)].isAnnounced = are;
    }
}

// Where proxies come, are announced and go, and there is no update: whenever twice as many couples are
// announced as were left the last time, so that each is looked at about once.
template <class Scalar>
bool Pairs<Scalar>::areManyAnnounced() const noexcept {
    return announced_.size() > fewAnnounced_ && grid_.removedAnnounced_.count > 0;
}

template <class Scalar>
void Pairs<Scalar>::findAnnouncedOfRemoved() {
    if (!areManyAnnounced()) {
        return;
    }
    stillAnnounced_.clear();
    for (const Couple c : announced_.keys()) {
        const bool areAlive = grid_.isAlive(first(c)) && grid_.isAlive(second(c));
        (areAlive ? stillAnnounced_ : lost_).push_back(c);
    }
}

template <class Scalar>
void Pairs<Scalar>::endAnnouncedOfRemoved() noexcept {
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
    grid_.giveBack(grid_.removedAnnounced_);
}

template PairChanges Pairs<float>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<float>::announce(ProxyId, std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<float>::refilter(ProxyId, PairFilter) &;
template PairChanges Pairs<float>::refilter(std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<float>::refilter(std::span<const ProxyPair>, PairFilter) &;
template bool Pairs<float>::isPair(const ProxyPair&) const noexcept;
template PairChanges Pairs<float>::refilterAll(PairFilter) &;
template bool Pairs<float>::wouldFind(std::uint32_t, std::uint32_t) const;
template void Pairs<float>::askAgain(Couple);
template PairChanges Pairs<float>::decideBetween(PairFilter);
template void Pairs<float>::announceUnknown() noexcept;
template void Pairs<float>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool Pairs<float>::areManyAnnounced() const noexcept;
template void Pairs<float>::findAnnouncedOfRemoved();
template void Pairs<float>::endAnnouncedOfRemoved() noexcept;
template PairChanges Pairs<double>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::announce(ProxyId, std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<double>::refilter(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::refilter(std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<double>::refilter(std::span<const ProxyPair>, PairFilter) &;
template bool Pairs<double>::isPair(const ProxyPair&) const noexcept;
template PairChanges Pairs<double>::refilterAll(PairFilter) &;
template bool Pairs<double>::wouldFind(std::uint32_t, std::uint32_t) const;
template void Pairs<double>::askAgain(Couple);
template PairChanges Pairs<double>::decideBetween(PairFilter);
template void Pairs<double>::announceUnknown() noexcept;
template void Pairs<double>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool Pairs<double>::areManyAnnounced() const noexcept;
template void Pairs<double>::findAnnouncedOfRemoved();
template void Pairs<double>::endAnnouncedOfRemoved() noexcept;

}  // namespace hashphase
