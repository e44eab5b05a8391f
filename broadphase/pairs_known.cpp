// SPDX-License-Identifier: Zlib

// Which couples overlapped at the last update, or have been announced since, and which have come to
// overlap: of one proxy, or of all.

#include <broadphase/pairs.hpp>

#include <broadphase/search/join.hpp>
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

}  // namespace

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
void Pairs<Scalar>::forKnownCouples(std::uint32_t slot, VisitCouple visit) {
    forOverlapsAtUpdate(slot, visit);
    announced_.forEachOf(slot, visit);
    forSwept(slot, visit);
}

template <class Scalar>
void Pairs<Scalar>::forOverlapsAtUpdate(std::uint32_t slot, VisitCouple visit) {
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
void Pairs<Scalar>::forSwept(std::uint32_t slot, VisitCouple visit) {
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

// forKnownCouples() of all; some twice, where they are announced or kept.
template <class Scalar>
void Pairs<Scalar>::forAllKnown(VisitCouple visit) {
    indexLastUpdate(0);
    const ProxyGroups* const groups = grid_.groupsOfAllAtUpdate();
    const auto visitIfTheyDid = [&](std::uint32_t a, std::uint32_t b) {
        if (wasKnown(a, b)) {
            visit(couple(a, b));
        }
    };
    detail::KernelCost cost;
    detail::forOverlaps(*tableOfUpdate_, groups, cost, visitIfTheyDid);
    detail::forOverlaps(grid_.resting_, groups, cost, visitIfTheyDid);
    bounds_.clear();
    for (const std::uint32_t slot : tableOfUpdate_->entrySlots()) {
        bounds_.push(grid_.before(slot));
    }
    const detail::GroupsView view{groups, tableOfUpdate_->entrySlots().data(), {}};
    detail::forOverlaps(bounds_.columns(), bounds_.size(), grid_.resting_,
                        groups != nullptr ? &view : nullptr, cost,
                        [&](std::uint32_t entry, std::uint32_t resting) {
                            visitIfTheyDid(tableOfUpdate_->slot(entry), resting);
                        });
    for (const std::span<const Couple> couples :
         {announced_.keys(), kept_.keys(), std::span<const Couple>(swept_)}) {
        std::for_each(couples.begin(), couples.end(), visit);
    }
    const std::span<const Couple> pairs =
        remembersPairs() ? pile_->pairs.keys() : std::span<const Couple>();
    for (const Couple c : pairs) {  // that are kept
        if (!couldPair(c) && !announced_.contains(c) && !isSwept(c)) {
            visit(c);
        }
    }
}

// The proxy's couples that overlap now, did not at the last update, and were not announced since; those
// with others that are wanted.
template <class Scalar>
void Pairs<Scalar>::findUnknown(std::uint32_t slot, FunctionRef<bool(std::uint32_t)> isWanted) {
    const auto add = [&](ProxyId other) {
        if (other.index != slot && isWanted(other.index)) {
            addIfUnknown(slot, other.index);
        }
    };
    CollectInto<decltype(add)> collector{add};
    grid_.visit(BoxRegion<Scalar>{boxAtStart(slot)}, collector);
}

template <class Scalar>
void Pairs<Scalar>::addIfUnknown(std::uint32_t slot, std::uint32_t other) {
    const Couple c = couple(slot, other);
    if (!wasKnown(slot, other) && grid_.mayPairNow(slot, other) && touchAtStart(slot, other) &&
        !announced_.contains(c) && !isSwept(c)) {
        unknown_.push_back(c);
        asked_.push_back(c);
    }
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

template void Pairs<float>::indexLastUpdate(std::size_t);
template void Pairs<float>::forKnownCouples(std::uint32_t, VisitCouple);
template void Pairs<float>::forOverlapsAtUpdate(std::uint32_t, VisitCouple);
template void Pairs<float>::forSwept(std::uint32_t, VisitCouple);
template void Pairs<float>::forAllKnown(VisitCouple);
template void Pairs<float>::findUnknown(std::uint32_t, FunctionRef<bool(std::uint32_t)>);
template void Pairs<float>::findUnknown(std::uint32_t);
template void Pairs<float>::addIfUnknown(std::uint32_t, std::uint32_t);
template Aabb<float> Pairs<float>::boxAtStart(std::uint32_t) const;
template bool Pairs<float>::touchAtStart(std::uint32_t, std::uint32_t) const;
template void Pairs<double>::indexLastUpdate(std::size_t);
template void Pairs<double>::forKnownCouples(std::uint32_t, VisitCouple);
template void Pairs<double>::forOverlapsAtUpdate(std::uint32_t, VisitCouple);
template void Pairs<double>::forSwept(std::uint32_t, VisitCouple);
template void Pairs<double>::forAllKnown(VisitCouple);
template void Pairs<double>::findUnknown(std::uint32_t, FunctionRef<bool(std::uint32_t)>);
template void Pairs<double>::findUnknown(std::uint32_t);
template void Pairs<double>::addIfUnknown(std::uint32_t, std::uint32_t);
template Aabb<double> Pairs<double>::boxAtStart(std::uint32_t) const;
template bool Pairs<double>::touchAtStart(std::uint32_t, std::uint32_t) const;

}  // namespace hashphase
