// SPDX-License-Identifier: Zlib

// Which couples have come to overlap.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/search/join.hpp>

#include <algorithm>

namespace hashphase::detail {
namespace {

// Where only a few share a cell, what may not pair is sooner taken out of what a search has found, where
// it is little, than left out by the search, which has to look at the groups of all.
template <class Scalar>
bool isCrowded(const Table<Scalar>& table) {
    constexpr std::uint32_t kFew = 32;
    return mostTogether(table) > kFew;
}

template <class IsOut>
void takeOut(PairList& pairs, const IsOut& isOut) {
    IndexPair* const begin = pairs.resize(pairs.size());
    IndexPair* const end = std::remove_if(begin, begin + pairs.size(), isOut);
    static_cast<void>(pairs.resize(static_cast<std::size_t>(end - begin)));
}

}  // namespace

// A couple is born when its boxes overlap now and did not at the last update.
template <class Scalar>
bool PairTracker<Scalar>::findBegun(bool someCameToRest, PairFilter filter,
                                    ParallelFor parallelFor) {
    if (remembersPairs()) {
        findBegunOfPairs(filter, parallelFor);
        return true;
    }
    if (doesRefuseMost(filter)) {
        return false;
    }
    const auto order = store_.tables.mobile.order();
    entryOf_.resize(store_.proxies.mobile.size());
    for (std::uint32_t entry = 0; entry < order.size(); ++entry) {
        entryOf_[order[entry]] = entry;
    }
    carryToRest(someCameToRest);
    joinMobile(parallelFor);
    walkResting(parallelFor);
    if (store_.proxies.areRegrouped) {
        askAboutRegrouped();
    }
    if (announced_.size() > 0) {
        std::erase_if(asked_, [this](Couple c) { return announced_.contains(c); });
    }
    findSwept(parallelFor);
    askRefusedAgain();
    return true;
}

// Couples of a mobile one that has not changed and a resting one are not looked for again.
template <class Scalar>
void PairTracker<Scalar>::carryToRest(bool someCameToRest) {
    carried_.clear();
    if (store_.tables.resting.size() == 0) {
        return;
    }
    const auto isKept = [this](std::uint32_t mobile, std::uint32_t resting) {
        return store_.proxies.records[resting].place == Place::resting &&
               store_.proxies.records[mobile].place == Place::mobile &&
               !store_.proxies.changedNow(mobile);
    };
    for (const auto [place, slot] : toResting_.pairs()) {
        if (isKept(store_.proxies.mobile[place], slot)) {
            carried_.push({entryOf_[place], slot});
        }
    }
    if (!someCameToRest) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        const std::uint32_t slotA = store_.proxies.mobile[a];
        const std::uint32_t slotB = store_.proxies.mobile[b];
        if (isKept(slotA, slotB)) {
            carried_.push({entryOf_[a], slotB});
        } else if (isKept(slotB, slotA)) {
            carried_.push({entryOf_[b], slotA});
        }
    }
}

template <class Scalar>
void PairTracker<Scalar>::joinMobile(ParallelFor parallelFor) {
    const Table<Scalar>& table = store_.tables.mobile;
    KernelCost cost;
    amongMobile_.clear();
    const GroupKinds::Set kinds = store_.frame.mobileKinds;
    const bool someRefuse = store_.proxies.groupKinds.refuse(kinds, kinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    joinTable(table, parallelFor, parts_, amongMobile_, cost,
              areToldApart ? store_.proxies.groups.data() : nullptr,
              store_.proxies.groupKinds.together(kinds));
    if (someRefuse && !areToldApart) {
        takeOut(amongMobile_, [&](const IndexPair& pair) {
            return store_.proxies.doRefuse(table.slot(pair.a), table.slot(pair.b));
        });
    }
    cost_.boxesTested += cost.boxesTested;
    const auto fresh = selectApart(amongMobile_.pairs(), table.order().data(),
                                   store_.frame.before.data(), parallelFor);
    for (const auto [a, b] : fresh) {
        asked_.push_back(couple(table.slot(a), table.slot(b)));
    }
}

// Those couples of which the boxes, numbered order[a] and order[b], do not overlap; valid until the
// next call.
template <class Scalar>
std::span<const IndexPair> PairTracker<Scalar>::selectApart(std::span<const IndexPair> couples,
                                                            const std::uint32_t* order,
                                                            const PaddedBox<Scalar>* boxes,
                                                            ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 8192;
    selected_.clear();
    KernelCost none;
    const auto select = [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost&) {
        detail::makeRoom(sink, last - first);
        sink.next += kernels<Scalar>().selectApart(couples.data() + first, last - first, order,
                                                   boxes, sink.next);
    };
    parts_.collect(parallelFor, couples.size(), kGrain, selected_, none, select);
    return selected_.pairs();
}

// What changed against the resting proxies.
template <class Scalar>
void PairTracker<Scalar>::walkResting(ParallelFor parallelFor) {
    toResting_.swap(carried_);
    if (store_.tables.resting.size() == 0) {
        return;
    }
    const Table<Scalar>& table = store_.tables.mobile;
    walkers_.clear();
    searchedSlots_.clear();
    bounds_.clear();
    const bool someRefuse =
        store_.proxies.groupKinds.refuse(store_.frame.changedKinds, store_.tables.restingKinds);
    const bool areToldApart = someRefuse && isCrowded(store_.tables.resting);
    for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
        const std::uint32_t slot = table.slot(entry);
        if (store_.proxies.changedNow(slot)) {
            walkers_.push_back(entry);
            bounds_.push(table.box(entry));
            if (areToldApart) {
                searchedSlots_.push_back(slot);
            }
        }
    }
    const GroupsView view{store_.proxies.groups.data(), searchedSlots_.data(),
                          store_.proxies.groupKinds.together(store_.tables.restingKinds)};
    KernelCost cost;
    selected_.clear();
    walkTable(store_.tables.resting, bounds_.columns(), bounds_.size(), parallelFor, parts_,
              selected_, cost, areToldApart ? &view : nullptr);
    cost_.boxesTested += cost.boxesTested;
    if (someRefuse && !areToldApart) {
        takeOut(selected_, [&](const IndexPair& pair) {
            return store_.proxies.doRefuse(table.slot(walkers_[pair.a]),
                                           store_.tables.resting.slot(pair.b));
        });
    }
    const bool isShifted = !store_.proxies.boxesAtUpdate.empty();
    for (const auto [walker, restingEntry] : selected_.pairs()) {
        const std::uint32_t entry = walkers_[walker];
        const std::uint32_t slot = store_.tables.resting.slot(restingEntry);
        toResting_.push({entry, slot});
        // Not by their slots: these boxes are at hand.
        const PaddedBox<Scalar>& before = store_.frame.before[table.order()[entry]];
        const Box resting =
            isShifted ? store_.proxies.boxAtUpdate(slot) : store_.tables.resting.box(restingEntry);
        if (!overlaps(unpadded(before), resting)) {
            asked_.push_back(couple(table.slot(entry), slot));
        }
    }
}

template bool PairTracker<float>::findBegun(bool, PairFilter, ParallelFor);
template void PairTracker<float>::carryToRest(bool);
template void PairTracker<float>::joinMobile(ParallelFor);
template void PairTracker<float>::walkResting(ParallelFor);
template std::span<const IndexPair> PairTracker<float>::selectApart(std::span<const IndexPair>,
                                                                    const std::uint32_t*,
                                                                    const PaddedBox<float>*,
                                                                    ParallelFor);
template bool PairTracker<double>::findBegun(bool, PairFilter, ParallelFor);
template void PairTracker<double>::carryToRest(bool);
template void PairTracker<double>::joinMobile(ParallelFor);
template void PairTracker<double>::walkResting(ParallelFor);
template std::span<const IndexPair> PairTracker<double>::selectApart(std::span<const IndexPair>,
                                                                     const std::uint32_t*,
                                                                     const PaddedBox<double>*,
                                                                     ParallelFor);

}  // namespace hashphase::detail
