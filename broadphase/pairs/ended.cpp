// SPDX-License-Identifier: Zlib

// Which candidates overlap no more.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/search/join.hpp>

#include <memory>

namespace hashphase::detail {

// A candidate dies when its boxes overlapped at the last update, or were found between updates, and do not
// now, or when one of the two sweeps now, unless they touch on their ways, see findSwept(). All those
// that are not watched are found here before their boxes are lost.
template <class Scalar>
void PairTracker<Scalar>::findEnded(ParallelFor parallelFor) {
    tableOfUpdate_ = nullptr;
    if (remembersPairs()) {
        return;  // see findBegunOfPairs()
    }
    const auto watched = amongMobile_.pairs();
    cost_.pairsWatched = watched.size() + toResting_.size();
    for (const auto [a, b] : selectApart(watched, nullptr, frame_.now.data(), parallelFor)) {
        endedPairs_.push_back(pairKey(proxies_.mobile[a], proxies_.mobile[b]));
    }
    constexpr std::size_t kAhead = 12;
    const auto toResting = toResting_.pairs();
    for (std::size_t i = 0; i < toResting.size(); ++i) {
        if (i + kAhead < toResting.size()) {
            prefetch(&proxies_.records[toResting[i + kAhead].b]);
        }
        const auto [place, proxyIndex] = toResting[i];
        const Box& resting = proxies_.standingBox(proxies_.records[proxyIndex]);
        if (!overlaps(unpadded(frame_.now[place]), resting)) {
            endedPairs_.push_back(pairKey(proxies_.mobile[place], proxyIndex));
        }
    }
    for (const PairKey c : immediate_.keys()) {
        endIfSeparated(c);
    }
    findEndedOfWoken(parallelFor);
    findKept();
}

// Candidates of two that rest are not watched. When one wakes, its candidates are those of its box before:
// found in the resting table where the other one has not changed, and among the woken otherwise.
template <class Scalar>
void PairTracker<Scalar>::findEndedOfWoken(ParallelFor parallelFor) {
    const GroupKinds::Set kinds = listWoken();
    const GroupsView view{proxies_.groupsOfAllAtUpdate(), proxies_.woken.data(),
                          proxies_.groupKinds.together(tables_.restingKinds)};
    const bool someRefuse = proxies_.groupKinds.refuse(kinds, tables_.restingKinds);
    KernelCost cost;
    selected_.clear();
    queryTable(tables_.resting, bounds_.columns(), bounds_.size(), parallelFor, parts_, selected_,
               cost, someRefuse ? &view : nullptr);
    for (const auto [woken, entry] : selected_.pairs()) {
        endIfWokenApart(proxies_.woken[woken], tables_.resting.proxyIndex(entry));
    }
    if (proxies_.woken.size() > 1) {
        joinWoken(kinds, parallelFor, cost);
    }
    cost_.boxesTested += cost.boxesTested;
}

// Sets wokenBoxes_ and bounds_ to their boxes of the last update; returns their kinds.
template <class Scalar>
GroupKinds::Set PairTracker<Scalar>::listWoken() {
    wokenBoxes_.clear();
    bounds_.clear();
    GroupKinds::Set kinds = 0;
    const ProxyGroups* const groups = proxies_.groupsOfAllAtUpdate();
    for (const std::uint32_t proxyIndex : proxies_.woken) {
        wokenBoxes_.push_back(padded(proxies_.boxAtUpdate(proxyIndex)));
        bounds_.push(proxies_.before(proxyIndex));
        if (groups != nullptr) {
            kinds |=
                GroupKinds::bit(proxies_.groupKinds.numberOf(groups[2 * std::size_t{proxyIndex}]));
        }
    }
    return kinds;
}

template <class Scalar>
void PairTracker<Scalar>::joinWoken(GroupKinds::Set kinds, ParallelFor parallelFor,
                                    KernelCost& cost) {
    Table<Scalar>& table = wokenTable();
    const ProxyGroups* const groups =
        proxies_.groupKinds.refuse(kinds, kinds) ? proxies_.groupsOfAllAtUpdate() : nullptr;
    table.build(proxies_.woken, wokenBoxes_, store_.fixedSizes(), parallelFor, groups);
    selected_.clear();
    joinTable(table, parallelFor, parts_, selected_, cost, groups,
              proxies_.groupKinds.together(kinds));
    for (const auto [a, b] : selected_.pairs()) {
        endIfWokenApart(table.proxyIndex(a), table.proxyIndex(b));
    }
}

template <class Scalar>
void PairTracker<Scalar>::endIfWokenApart(std::uint32_t a, std::uint32_t b) {
    const PairKey c = pairKey(a, b);
    if (!proxies_.boxesAtUpdate.empty() && !proxies_.overlappedAtUpdate(a, b)) {
        return;  // a shift of the origin has rounded them together
    }
    if (refusedAtRest_.contains(c)) {
        refused_.findOrInsert(c);
        refusedAtRest_.erase(c);
    }
    endIfSeparated(c);
    if (proxies_.areRegrouped) {
        keepIfPair(c);
    }
}

template <class Scalar>
Table<Scalar>& PairTracker<Scalar>::wokenTable() {
    if (wokenTable_ == nullptr) {
        wokenTable_ = std::make_unique<Table<Scalar>>();
    }
    return *wokenTable_;
}

template <class Scalar>
void PairTracker<Scalar>::endIfSeparated(PairKey c) {
    if (!overlapNow(c)) {
        endedPairs_.push_back(c);
    }
}

template void PairTracker<float>::findEnded(ParallelFor);
template void PairTracker<float>::findEndedOfWoken(ParallelFor);
template GroupKinds::Set PairTracker<float>::listWoken();
template void PairTracker<float>::joinWoken(GroupKinds::Set, ParallelFor, KernelCost&);
template void PairTracker<float>::endIfWokenApart(std::uint32_t, std::uint32_t);
template void PairTracker<float>::endIfSeparated(PairKey);
template Table<float>& PairTracker<float>::wokenTable();
template void PairTracker<double>::findEnded(ParallelFor);
template void PairTracker<double>::findEndedOfWoken(ParallelFor);
template GroupKinds::Set PairTracker<double>::listWoken();
template void PairTracker<double>::joinWoken(GroupKinds::Set, ParallelFor, KernelCost&);
template void PairTracker<double>::endIfWokenApart(std::uint32_t, std::uint32_t);
template void PairTracker<double>::endIfSeparated(PairKey);
template Table<double>& PairTracker<double>::wokenTable();

}  // namespace hashphase::detail
