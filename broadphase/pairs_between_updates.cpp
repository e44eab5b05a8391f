// SPDX-License-Identifier: Zlib

// What Pairs tells between updates: of one proxy, at once.

#include <broadphase/pairs.hpp>

#include <broadphase/detail/join.hpp>
#include <broadphase/sweeps.hpp>

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
    findAnnouncedOfRemoved();
    findUnknown(id.index);
    return decideBetween(filter);
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
            isNamed_[id.index] = 1;
        }
        askAgainAboutMany([this](std::uint32_t slot) { return isNamed_[slot] != 0; });
        return decideBetween(filter);
    }
    for (const ProxyId id : ids) {
        if (grid_.cost_.changed > 0) {
            findUnknown(id.index);
        }
        forKnownCouples(id.index, [this](Couple c) { askAgain(c); });
    }
    return decideBetween(filter);
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilterAll(PairFilter filter) & {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), kMustNotAsk);
    beginCall();
    recover();
    findAnnouncedOfRemoved();
    askAgainAboutMany([](std::uint32_t) { return true; });
    return decideBetween(filter);
}

// What is not known yet is of one that has changed.
template <class Scalar>
template <class IsNamed>
void Pairs<Scalar>::askAgainAboutMany(const IsNamed& isNamed) {
    if (grid_.cost_.changed > 0) {
        for (const std::uint32_t slot : grid_.mobileSlots_) {
            if (grid_.changedNow(slot) && grid_.isAlive(slot)) {
                findUnknown(slot, isNamed);
            }
        }
    }
    forAllKnown([&](Couple c) {
        if (isNamed(first(c)) || isNamed(second(c))) {
            askAgain(c);
        }
    });
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
    for (std::vector<Couple>* couples : {&asked_, &standing_, &unknown_}) {
        sortCouples(*couples);
        couples->erase(std::unique(couples->begin(), couples->end()), couples->end());
    }
    ask(filter, toldBetween_);
    endAnnouncedOfRemoved();
    announceUnknown();
    decide();
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

// --- What is known -------------------------------------------------------------------------------

// Afterwards tableOfUpdate_ has all but `mostUnindexed` of the proxies that are mobile now, and that
// were there at the last update. Each time that it is filed for more of them it has a quarter more, so
// that this costs each of them little.
template <class Scalar>
void Pairs<Scalar>::indexLastUpdate(std::size_t mostUnindexed) {
    const bool isStale =
        shiftOfUpdate_ != grid_.shiftCount_ ||
        (tableOfUpdate_ == &grid_.mobile_ && filingOfUpdate_ != grid_.filingCount_);
    if (isStale) {
        tableOfUpdate_ = nullptr;
    }
    if (tableOfUpdate_ != nullptr && grid_.woken_.size() - indexedWoken_ <= mostUnindexed) {
        return;
    }
    // What has come since the last update had no box then.
    const auto listed = grid_.mobileSlots_.begin();
    std::vector<std::uint32_t>& slots = searchedSlots_;
    slots.assign(listed, listed + static_cast<std::ptrdiff_t>(grid_.listedAtUpdate_));
    slots.insert(slots.end(), grid_.woken_.begin(), grid_.woken_.end());
    wokenBoxes_.clear();
    for (const std::uint32_t slot : slots) {
        wokenBoxes_.push_back(detail::padded(grid_.boxAtUpdate(slot)));
    }
    tableOfUpdate_ = nullptr;
    wokenTable().build(slots, wokenBoxes_, grid_.fixedSizes(), serialFor,
                       grid_.groupsOfAllAtUpdate());
    tableOfUpdate_ = wokenTable_.get();
    indexedWoken_ = grid_.woken_.size();
    shiftOfUpdate_ = grid_.shiftCount_;
}

// Calls visit for each of the proxy's couples that overlapped at the last update, or met on their ways
// then, or were announced since.
template <class Scalar>
template <class Visit>
void Pairs<Scalar>::forKnownCouples(std::uint32_t slot, const Visit& visit) {
    forOverlapsAtUpdate(slot, visit);
    announced_.forEachOf(slot, visit);
    forSwept(slot, visit);
}

template <class Scalar>
template <class Visit>
void Pairs<Scalar>::forOverlapsAtUpdate(std::uint32_t slot, const Visit& visit) {
    constexpr std::size_t kFew = 64;
    indexLastUpdate(kFew + (grid_.listedAtUpdate_ + indexedWoken_) / 4);
    const auto visitIfTheyDid = [&](std::uint32_t other) {
        if (other != slot && wasKnown(slot, other)) {
            visit(couple(slot, other));
        }
    };
    const auto walk = [&](const detail::Table<Scalar>& table, const Box& box) {
        bounds_.clear();
        bounds_.push(box);
        detail::FewPairs found;
        detail::KernelCost cost;
        found.assign([&](detail::PairSink& sink) {
            detail::walkTogether(table, bounds_.columns(), 1, sink, cost);
        });
        for (const auto [query, entry] : found.pairs()) {
            visitIfTheyDid(table.slot(entry));
        }
    };
    const bool isOwn = tableOfUpdate_ == wokenTable_.get();  // in the coordinates of then
    walk(*tableOfUpdate_, isOwn ? grid_.boxAtUpdate(slot) : grid_.before(slot));
    walk(grid_.resting_, grid_.before(slot));
    for (std::size_t i = indexedWoken_; i < grid_.woken_.size(); ++i) {
        visitIfTheyDid(grid_.woken_[i]);
    }
}

template <class Scalar>
template <class Visit>
void Pairs<Scalar>::forSwept(std::uint32_t slot, const Visit& visit) {
    if (swept_.empty()) {
        return;
    }
    if (sweptBySecond_.empty()) {
        std::vector<Couple> turned(swept_.size());
        std::transform(swept_.begin(), swept_.end(), turned.begin(),
                       [](Couple c) { return c << 32 | c >> 32; });
        sortCouples(turned);
        sweptBySecond_.swap(turned);
    }
    for (const auto* couples : {&swept_, &sweptBySecond_}) {
        auto at = std::lower_bound(couples->begin(), couples->end(), Couple{slot} << 32);
        for (; at != couples->end() && *at >> 32 == slot; ++at) {
            visit(couple(first(*at), second(*at)));
        }
    }
}

// forKnownCouples() of all.
template <class Scalar>
template <class Visit>
void Pairs<Scalar>::forAllKnown(const Visit& visit) {
    indexLastUpdate(0);
    const ProxyGroups* const groups = grid_.groupsOfAllAtUpdate();
    const auto visitIfTheyDid = [&](std::uint32_t a, std::uint32_t b) {
        if (wasKnown(a, b)) {
            visit(couple(a, b));
        }
    };
    detail::KernelCost cost;
    const detail::Table<Scalar>* const restingTable = &grid_.resting_;
    for (const detail::Table<Scalar>* table : {tableOfUpdate_, restingTable}) {
        selected_.clear();
        detail::joinTable(*table, serialFor, parts_, selected_, cost, groups);
        for (const auto [a, b] : selected_.pairs()) {
            visitIfTheyDid(table->slot(a), table->slot(b));
        }
    }
    bounds_.clear();
    for (const std::uint32_t slot : tableOfUpdate_->entrySlots()) {
        bounds_.push(grid_.before(slot));
    }
    selected_.clear();
    const detail::GroupsView view{groups, tableOfUpdate_->entrySlots().data(), {}};
    detail::walkTable(grid_.resting_, bounds_.columns(), bounds_.size(), serialFor, parts_,
                      selected_, cost, groups != nullptr ? &view : nullptr);
    for (const auto [entry, resting] : selected_.pairs()) {
        visitIfTheyDid(tableOfUpdate_->slot(entry), grid_.resting_.slot(resting));
    }
    for (const std::span<const Couple> couples :
         {announced_.keys(), kept_.keys(), std::span<const Couple>(swept_)}) {
        std::for_each(couples.begin(), couples.end(), visit);
    }
}

// The proxy's couples that overlap now, did not at the last update, and were not announced since; those
// of which one is named.
template <class Scalar>
template <class IsNamed>
void Pairs<Scalar>::findUnknown(std::uint32_t slot, const IsNamed& isNamed) {
    const auto add = [&](ProxyId other) {
        if (other.index != slot && (isNamed(slot) || isNamed(other.index)) &&
            !wasKnown(slot, other.index) && grid_.mayPairNow(slot, other.index) &&
            touchAtStart(slot, other.index)) {
            const Couple c = couple(slot, other.index);
            if (!announced_.contains(c) && !isSwept(c)) {
                unknown_.push_back(c);
                asked_.push_back(c);
            }
        }
    };
    CollectInto<decltype(add)> collector{add};
    grid_.visit(BoxRegion<Scalar>{boxAtStart(slot)}, collector);
}

// Where a proxy alive is now, of what sweeps where its way begins.
template <class Scalar>
Aabb<Scalar> Pairs<Scalar>::boxAtStart(std::uint32_t slot) const {
    return sweeps_ != nullptr ? sweeps_->motion(grid_.idOf(slot)).box : grid_.records_[slot].box;
}

template <class Scalar>
bool Pairs<Scalar>::touchAtStart(std::uint32_t a, std::uint32_t b) const {
    return overlaps(boxAtStart(a), boxAtStart(b));
}

template <class Scalar>
void Pairs<Scalar>::findUnknown(std::uint32_t slot) {
    findUnknown(slot, [](std::uint32_t) { return true; });
}

template PairChanges Pairs<float>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<float>::refilter(ProxyId, PairFilter) &;
template PairChanges Pairs<float>::refilter(std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<float>::refilterAll(PairFilter) &;
template void Pairs<float>::askAgain(Couple);
template PairChanges Pairs<float>::decideBetween(PairFilter);
template void Pairs<float>::announceUnknown() noexcept;
template void Pairs<float>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool Pairs<float>::areManyAnnounced() const noexcept;
template void Pairs<float>::findAnnouncedOfRemoved();
template void Pairs<float>::endAnnouncedOfRemoved() noexcept;
template void Pairs<float>::indexLastUpdate(std::size_t);
template void Pairs<float>::findUnknown(std::uint32_t);
template Aabb<float> Pairs<float>::boxAtStart(std::uint32_t) const;
template bool Pairs<float>::touchAtStart(std::uint32_t, std::uint32_t) const;
template PairChanges Pairs<double>::announce(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::refilter(ProxyId, PairFilter) &;
template PairChanges Pairs<double>::refilter(std::span<const ProxyId>, PairFilter) &;
template PairChanges Pairs<double>::refilterAll(PairFilter) &;
template void Pairs<double>::askAgain(Couple);
template PairChanges Pairs<double>::decideBetween(PairFilter);
template void Pairs<double>::announceUnknown() noexcept;
template void Pairs<double>::markAnnounced(std::span<const Couple>, bool) noexcept;
template bool Pairs<double>::areManyAnnounced() const noexcept;
template void Pairs<double>::findAnnouncedOfRemoved();
template void Pairs<double>::endAnnouncedOfRemoved() noexcept;
template void Pairs<double>::indexLastUpdate(std::size_t);
template void Pairs<double>::findUnknown(std::uint32_t);
template Aabb<double> Pairs<double>::boxAtStart(std::uint32_t) const;
template bool Pairs<double>::touchAtStart(std::uint32_t, std::uint32_t) const;

}  // namespace hashphase
