// SPDX-License-Identifier: Zlib

// Which couples overlap no more.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/search/join.hpp>

#include <memory>

namespace hashphase::detail {

// A couple dies when its boxes overlapped at the last update, or were announced since, and do not
// now, or when one of the two sweeps now, unless they touch on their ways, see findSwept(). All those
// that are not watched are found here before their boxes are lost.
template <class Scalar>
void PairTracker<Scalar>::findEnded(ParallelFor parallelFor) {
    tableOfUpdate_ = nullptr;
    if (remembersPairs()) {
        return;  // see findBegunOfPairs()
    }
    const auto watched = amongMobile_.pairs();
    cost_.couplesWatched = watched.size() + toResting_.size();
    for (const auto [a, b] : selectApart(watched, nullptr, store_.frame.now.data(), parallelFor)) {
        lost_.push_back(couple(store_.proxies.mobile[a], store_.proxies.mobile[b]));
    }
    constexpr std::size_t kAhead = 12;
    const auto toResting = toResting_.pairs();
    for (std::size_t i = 0; i < toResting.size(); ++i) {
        if (i + kAhead < toResting.size()) {
            prefetch(&store_.proxies.records[toResting[i + kAhead].b]);
        }
        const auto [place, slot] = toResting[i];
        const Box& resting = store_.proxies.standingBox(store_.proxies.records[slot]);
        if (!overlaps(unpadded(store_.frame.now[place]), resting)) {
            lost_.push_back(couple(store_.proxies.mobile[place], slot));
        }
    }
    for (const Couple c : announced_.keys()) {
        loseIfApart(c);
    }
    findDeathsOfWoken(parallelFor);
    findKept();
}

// Couples of two that rest are not watched. When one wakes, its couples are those of its box before:
// found in the resting table where the other one has not changed, and among the woken otherwise.
template <class Scalar>
void PairTracker<Scalar>::findDeathsOfWoken(ParallelFor parallelFor) {
    const bool isShifted = !store_.proxies.boxesAtUpdate.empty();
    const auto wake = [this, isShifted](std::uint32_t a, std::uint32_t b) {
        const Couple c = couple(a, b);
        if (isShifted && !store_.proxies.overlappedAtUpdate(a, b)) {
            return;  // a shift of the origin has rounded them together
        }
        if (refusedAtRest_.contains(c)) {
            refused_.findOrInsert(c);
            refusedAtRest_.erase(c);
        }
        loseIfApart(c);
        if (store_.proxies.areRegrouped) {
            keepIfPair(c);
        }
    };
    wokenBoxes_.clear();
    bounds_.clear();
    GroupKinds::Set wokenKinds = 0;
    const ProxyGroups* const groups = store_.proxies.groupsOfAllAtUpdate();
    for (const std::uint32_t slot : store_.proxies.woken) {
        wokenBoxes_.push_back(padded(store_.proxies.boxAtUpdate(slot)));
        bounds_.push(store_.proxies.before(slot));
        if (groups != nullptr) {
            wokenKinds |=
                GroupKinds::bit(store_.proxies.groupKinds.numberOf(groups[2 * std::size_t{slot}]));
        }
    }
    const GroupsView view{groups, store_.proxies.woken.data(),
                          store_.proxies.groupKinds.together(store_.tables.restingKinds)};
    const bool areToldApart =
        store_.proxies.groupKinds.refuse(wokenKinds, store_.tables.restingKinds);
    KernelCost cost;
    selected_.clear();
    walkTable(store_.tables.resting, bounds_.columns(), bounds_.size(), parallelFor, parts_,
              selected_, cost, areToldApart ? &view : nullptr);
    for (const auto [woken, entry] : selected_.pairs()) {
        wake(store_.proxies.woken[woken], store_.tables.resting.slot(entry));
    }
    if (store_.proxies.woken.size() > 1) {
        Table<Scalar>& table = wokenTable();
        const ProxyGroups* own =
            store_.proxies.groupKinds.refuse(wokenKinds, wokenKinds) ? groups : nullptr;
        table.build(store_.proxies.woken, wokenBoxes_, store_.fixedSizes(), parallelFor, own);
        selected_.clear();
        joinTable(table, parallelFor, parts_, selected_, cost, own,
                  store_.proxies.groupKinds.together(wokenKinds));
        for (const auto [a, b] : selected_.pairs()) {
            wake(table.slot(a), table.slot(b));
        }
    }
    cost_.boxesTested += cost.boxesTested;
}

template <class Scalar>
Table<Scalar>& PairTracker<Scalar>::wokenTable() {
    if (wokenTable_ == nullptr) {
        wokenTable_ = std::make_unique<Table<Scalar>>();
    }
    return *wokenTable_;
}

template <class Scalar>
void PairTracker<Scalar>::loseIfApart(Couple c) {
    if (!overlapNow(c)) {
        lost_.push_back(c);
    }
}

template void PairTracker<float>::findEnded(ParallelFor);
template void PairTracker<float>::findDeathsOfWoken(ParallelFor);
template void PairTracker<float>::loseIfApart(Couple);
template Table<float>& PairTracker<float>::wokenTable();
template void PairTracker<double>::findEnded(ParallelFor);
template void PairTracker<double>::findDeathsOfWoken(ParallelFor);
template void PairTracker<double>::loseIfApart(Couple);
template Table<double>& PairTracker<double>::wokenTable();

}  // namespace hashphase::detail
