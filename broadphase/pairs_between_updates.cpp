// SPDX-License-Identifier: Zlib

// What Pairs tells between updates: of one proxy, at once.

#include <broadphase/pairs.hpp>

#include <broadphase/detail/join.hpp>

#include <algorithm>
#include <limits>

namespace hashphase {
namespace {

template <class Add>
struct CollectInto {
    Add& addTo;

    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) {
        addTo(id);
    }
    static constexpr double limit() { return std::numeric_limits<double>::infinity(); }
};

[[maybe_unused]] constexpr const char* kMustNotAsk =
    "Pairs are not announced, nor filtered again, from within the filter.";

}  // namespace

template <class Scalar>
PairChanges Pairs<Scalar>::announce(ProxyId id, PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can announce its pairs.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    beginCall();
    findUnknown(id.index);
    unknown_ = asked_;
    ask(filter, toldBetween_);
    announceUnknown();
    decide();
    return tell(toldBetween_);
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(ProxyId id, PairFilter filter) & {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can be filtered again.");
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    beginCall();
    recover();
    announcedBefore_.assign(announced_.keys().begin(), announced_.keys().end());
    findUnknown(id.index);
    unknown_ = asked_;
    forKnownCouples(id.index, [this](Couple c) {
        if (!isRefused(c) && grid_.isAlive(first(c)) && grid_.isAlive(second(c))) {
            standing_.push_back(c);
            asked_.push_back(c);
        } else if (isRefused(c) && (overlapNow(c) || isSwept(c))) {
            // Those apart for the moment are asked about by update(), should they meet again.
            asked_.push_back(c);
        }
    });
    ask(filter, toldBetween_);
    announceUnknown();
    decide();
    return tell(toldBetween_);
}

template <class Scalar>
void Pairs<Scalar>::announceUnknown() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const Couple c : unknown_) {
        announced_.findOrInsert(c);
    }
}

// Calls visit for each of the proxy's couples that overlapped at the last update or were announced
// since.
template <class Scalar>
template <class Visit>
void Pairs<Scalar>::forKnownCouples(std::uint32_t slot, const Visit& visit) const {
    const auto visitIfIts = [&](std::uint32_t a, std::uint32_t b) {
        if (a == slot || b == slot) {
            visit(couple(a, b));
        }
    };
    const auto& places = grid_.mobileSlots_;
    for (const auto [a, b] : amongMobile_.pairs()) {
        visitIfIts(places[a], places[b]);
    }
    for (const auto [place, resting] : toResting_.pairs()) {
        visitIfIts(places[place], resting);
    }
    for (const auto* couples : {&announcedBefore_, &swept_}) {
        for (const Couple c : *couples) {
            visitIfIts(first(c), second(c));
        }
    }
    const auto watchedEnd = places.begin() + static_cast<std::ptrdiff_t>(watchedMobileCount_);
    if (std::find(places.begin(), watchedEnd, slot) != watchedEnd) {
        return;
    }
    // It rested at the last update: couples with others that did are not watched.
    const Box& before = grid_.before(slot);
    detail::BoxColumns<Scalar> bounds;
    bounds.push(before);
    detail::PairParts parts;
    detail::PairList found;
    detail::KernelCost cost;
    detail::walkTable(grid_.resting_, bounds.columns(), 1, serialFor, parts, found, cost);
    for (const auto [query, entry] : found.pairs()) {
        const std::uint32_t other = grid_.resting_.slot(entry);
        if (other != slot && grid_.overlappedAtUpdate(slot, other)) {
            visit(couple(slot, other));
        }
    }
    for (const std::uint32_t other : grid_.woken_) {
        if (other != slot && grid_.overlappedAtUpdate(slot, other)) {
            visit(couple(slot, other));
        }
    }
}

// The proxy's couples that overlap now, did not at the last update, and were not announced since.
template <class Scalar>
void Pairs<Scalar>::findUnknown(std::uint32_t slot) {
    const auto add = [&](ProxyId other) {
        if (other.index != slot && !grid_.overlappedAtUpdate(slot, other.index)) {
            const Couple c = couple(slot, other.index);
            if (!announced_.contains(c) && !isSwept(c)) {
                asked_.push_back(c);
            }
        }
    };
    CollectInto<decltype(add)> collector{add};
    grid_.visit(BoxRegion<Scalar>{grid_.records_[slot].box}, collector);
}

template PairChanges Pairs<float>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<float>::refilter(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::refilter(ProxyId, PairFilter) &;
template void Pairs<float>::announceUnknown() noexcept;
template void Pairs<double>::announceUnknown() noexcept;
template void Pairs<float>::findUnknown(std::uint32_t);
template void Pairs<double>::findUnknown(std::uint32_t);

}  // namespace hashphase
