// SPDX-License-Identifier: Zlib

// Which couples overlap no more.

#include <broadphase/pairs.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/search/join.hpp>

#include <memory>

namespace hashphase {

// A couple dies when its boxes overlapped at the last update, or were announced since, and do not
// now, or when one of the two sweeps now, unless they touch on their ways, see findSwept(). All those
// that are not watched are found here before their boxes are lost.
template <class Scalar>
void Pairs<Scalar>::findDeaths(ParallelFor parallelFor) {
    const auto watched = amongMobile_.pairs();
    cost_.couplesWatched = watched.size() + toResting_.size();
    for (const auto [a, b] : selectApart(watched, nullptr, grid_.staged_.data(), parallelFor)) {
        lost_.push_back(couple(grid_.mobileSlots_[a], grid_.mobileSlots_[b]));
    }
    constexpr std::size_t kAhead = 12;
    const auto toResting = toResting_.pairs();
    for (std::size_t i = 0; i < toResting.size(); ++i) {
        if (i + kAhead < toResting.size()) {
            detail::prefetch(&grid_.records_[toResting[i + kAhead].b]);
        }
        const auto [place, slot] = toResting[i];
        const Box& resting = grid_.standingBox(grid_.records_[slot]);
        if (!overlaps(detail::unpadded(grid_.staged_[place]), resting)) {
            lost_.push_back(couple(grid_.mobileSlots_[place], slot));
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
void Pairs<Scalar>::findDeathsOfWoken(ParallelFor parallelFor) {
    const bool isShifted = !grid_.boxesAtUpdate_.empty();
    const auto wake = [this, isShifted](std::uint32_t a, std::uint32_t b) {
        const Couple c = couple(a, b);
        if (isShifted && !grid_.overlappedAtUpdate(a, b)) {
            return;  // a shift of the origin has rounded them together
        }
        if (refusedAtRest_.contains(c)) {
            refused_.findOrInsert(c);
            refusedAtRest_.erase(c);
        }
        loseIfApart(c);
        if (grid_.areRegrouped_) {
            keepIfPair(c);
        }
    };
    wokenBoxes_.clear();
    bounds_.clear();
    detail::GroupKinds::Set wokenKinds = 0;
    const ProxyGroups* const groups = grid_.groupsOfAllAtUpdate();
    for (const std::uint32_t slot : grid_.woken_) {
        wokenBoxes_.push_back(detail::padded(grid_.boxAtUpdate(slot)));
        bounds_.push(grid_.before(slot));
        if (groups != nullptr) {
            wokenKinds |=
                detail::GroupKinds::bit(grid_.groupKinds_.numberOf(groups[2 * std::size_t{slot}]));
        }
    }
    const detail::GroupsView view{groups, grid_.woken_.data(),
                                  grid_.groupKinds_.together(grid_.restingKinds_)};
    const bool areToldApart = grid_.groupKinds_.refuse(wokenKinds, grid_.restingKinds_);
    detail::KernelCost cost;
    selected_.clear();
    detail::walkTable(grid_.resting_, bounds_.columns(), bounds_.size(), parallelFor, parts_,
                      selected_, cost, areToldApart ? &view : nullptr);
    for (const auto [woken, entry] : selected_.pairs()) {
        wake(grid_.woken_[woken], grid_.resting_.slot(entry));
    }
    if (grid_.woken_.size() > 1) {
        detail::Table<Scalar>& table = wokenTable();
        const ProxyGroups* own =
            grid_.groupKinds_.refuse(wokenKinds, wokenKinds) ? groups : nullptr;
        table.build(grid_.woken_, wokenBoxes_, grid_.fixedSizes(), parallelFor, own);
        selected_.clear();
        detail::joinTable(table, parallelFor, parts_, selected_, cost, own,
                          grid_.groupKinds_.together(wokenKinds));
        for (const auto [a, b] : selected_.pairs()) {
            wake(table.slot(a), table.slot(b));
        }
    }
    cost_.boxesTested += cost.boxesTested;
}

template <class Scalar>
detail::Table<Scalar>& Pairs<Scalar>::wokenTable() {
    if (wokenTable_ == nullptr) {
        wokenTable_ = std::make_unique<detail::Table<Scalar>>();
    }
    return *wokenTable_;
}

template <class Scalar>
void Pairs<Scalar>::loseIfApart(Couple c) {
    if (!overlapNow(c)) {
        lost_.push_back(c);
    }
}

template void Pairs<float>::findDeaths(ParallelFor);
template void Pairs<float>::findDeathsOfWoken(ParallelFor);
template void Pairs<float>::loseIfApart(Couple);
template detail::Table<float>& Pairs<float>::wokenTable();
template void Pairs<double>::findDeaths(ParallelFor);
template void Pairs<double>::findDeathsOfWoken(ParallelFor);
template void Pairs<double>::loseIfApart(Couple);
template detail::Table<double>& Pairs<double>::wokenTable();

}  // namespace hashphase
