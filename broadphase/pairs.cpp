// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>

#include <broadphase/core/prefetch.hpp>
#include <broadphase/core/radix_sort.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/search/join.hpp>
#include <broadphase/sweeps.hpp>

#include <algorithm>
#include <iterator>
#include <memory>

namespace hashphase {
namespace {

// Where only a few share a cell, what may not pair is sooner taken out of what a search has found, where
// it is little, than left out by the search, which has to look at the groups of all.
template <class Scalar>
bool isCrowded(const detail::Table<Scalar>& table) {
    constexpr std::uint32_t kFew = 32;
    return detail::mostTogether(table) > kFew;
}

template <class IsOut>
void takeOut(detail::PairList& pairs, const IsOut& isOut) {
    detail::IndexPair* const begin = pairs.resize(pairs.size());
    detail::IndexPair* const end = std::remove_if(begin, begin + pairs.size(), isOut);
    static_cast<void>(pairs.resize(static_cast<std::size_t>(end - begin)));
}

}  // namespace

template <class Scalar>
Pairs<Scalar>::Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps) : grid_(grid), sweeps_(sweeps) {
    HASHPHASE_ASSERT(sweeps_ == nullptr || &sweeps_->grid_ == &grid_,
                     "Sweeps and Pairs are of the same grid.");
    HASHPHASE_ASSERT(!grid_.hasPairs_, "A grid has at most one Pairs.");
    grid_.forgetLastUpdate();
    grid_.hasPairs_ = true;
}

template <class Scalar>
void Pairs<Scalar>::setSweeps(Sweeps<Scalar>* sweeps) {
    HASHPHASE_ASSERT(sweeps == nullptr || &sweeps->grid_ == &grid_,
                     "Sweeps and Pairs are of the same grid.");
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&grid_),
                     "Sweeps are not given within a query, or within the filter.");
    grid_.endSweeps();
    sweeps_ = sweeps;
    if (sweeps_ != nullptr) {
        sweeps_->noteAllChanged();
    }
}

template <class Scalar>
Pairs<Scalar>::~Pairs() {
    grid_.endSweeps();
    grid_.hasPairs_ = false;
}

template <class Scalar>
void Pairs<Scalar>::clear() {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&grid_),
                     "Pairs and their grid are not cleared within a query, or within the filter.");
    // Made again, so that nothing is left of what was.
    Grid<Scalar>& grid = grid_;
    Sweeps<Scalar>* const sweeps = sweeps_;
    std::destroy_at(this);
    grid.clear();
    if (sweeps != nullptr) {
        std::destroy_at(sweeps);
        std::construct_at(sweeps, grid);
    }
    std::construct_at(this, grid, sweeps);
}

// --- An update -----------------------------------------------------------------------------------

template <class Scalar>
PairChanges Pairs<Scalar>::update(PairFilter filter, ParallelFor parallelFor) & {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(&grid_),
                     "An update is not begun within a query, or within the filter.");
    beginCall();
    cost_ = {};
    grid_.releaseAfterPeak();
    releaseAfterPeak();
    try {
        recover();
        if (!remembersPairs() && !findChanges(filter, parallelFor)) {
            beginSearch();
            grid_.wakeAll();
            recover();
            rememberPairs();
        }
        if (remembersPairs()) {
            findChangesOfPairs(filter, parallelFor);
        } else {
            ask(filter);
        }
        makeRoom(toldByUpdate_);
    } catch (...) {
        grid_.wakeAll();
        throw;
    }
    endUpdate();
    chooseSide(true);
    return tell(toldByUpdate_);
}

template <class Scalar>
void Pairs<Scalar>::beginCall() {
    if (pile_ != nullptr) {
        pile_->sampled.clear();
        pile_->sampledAccepted.clear();
    }
    beginSearch();
}

template <class Scalar>
void Pairs<Scalar>::beginSearch() {
    lost_.clear();
    asked_.clear();
    unknown_.clear();
    standing_.clear();
    if (pile_ != nullptr) {
        pile_->turned.clear();
    }
    keptNow_.clear();
    notKept_.clear();
    lapsed_.clear();
    bornCouples_.clear();
    diedCouples_.clear();
}

// Where memory has run out, everything is mobile, and what the last one has left to be watched
// are the couples of the boxes at that time.
template <class Scalar>
void Pairs<Scalar>::recover() {
    if (!grid_.isTorn_) {
        return;
    }
    refused_.reserve(refused_.size() + refusedAtRest_.size());
    tableOfUpdate_ = nullptr;
    grid_.stage(serialFor);
    detail::Table<Scalar>& table = wokenTable();
    const ProxyGroups* const groups = grid_.groupsOfAllAtUpdate();
    table.build(grid_.mobileSlots_, grid_.stagedBefore_, grid_.fixedSizes(), serialFor, groups);
    amongMobile_.clear();
    if (!remembersPairs()) {
        detail::KernelCost cost;
        selected_.clear();
        detail::joinTable(table, serialFor, parts_, selected_, cost, groups);
        for (const auto [a, b] : selected_.pairs()) {
            amongMobile_.push({table.order()[a], table.order()[b]});
        }
    }
    for (const Couple c : refusedAtRest_.keys()) {
        refused_.findOrInsert(c);
    }
    toResting_.clear();
    refusedAtRest_.clear();
    grid_.woken_.clear();
    grid_.listedAtUpdate_ = grid_.mobileSlots_.size();
    tableOfUpdate_ = wokenTable_.get();
    indexedWoken_ = 0;
    shiftOfUpdate_ = grid_.shiftCount_;
    grid_.isTorn_ = false;
}

// Returns false where the pairs had better be remembered: then it has changed nothing that is of use.
template <class Scalar>
bool Pairs<Scalar>::findChanges(PairFilter filter, ParallelFor parallelFor) {
    if (sweeps_ != nullptr) {
        sweeps_->beginUpdate();
    }
    for (const Couple c : kept_.keys()) {
        if (isRefused(c) && !mayPairNow(c)) {  // filtered again
            notKept_.push_back(c);
            lapsed_.push_back(c);
        }
    }
    if (grid_.cost_.changed == 0) {
        return true;
    }
    tableOfUpdate_ = nullptr;
    grid_.stage(parallelFor);
    findDeaths(parallelFor);
    const bool someCameToRest = grid_.putQuietToRest(parallelFor);
    grid_.fileMobile(parallelFor);
    if (doesRefuseMost(filter)) {
        return false;
    }
    findBirths(someCameToRest, parallelFor);
    findSwept(parallelFor);
    askRefusedAgain();
    return true;
}

template <class Scalar>
void Pairs<Scalar>::endUpdate() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const Couple c : lost_) {
        lose(c);
        kept_.erase(c);
    }
    for (const Couple c : keptNow_) {
        kept_.findOrInsert(c);
    }
    for (const Couple c : notKept_) {
        kept_.erase(c);
    }
    for (const Couple c : lapsed_) {
        forgetRefused(c);
    }
    if (grid_.cost_.changed > 0) {
        swept_.swap(sweptNow_);
        grid_.settle();
        tableOfUpdate_ = &grid_.mobile_;
        indexedWoken_ = 0;
        filingOfUpdate_ = grid_.filingCount_;
        shiftOfUpdate_ = grid_.shiftCount_;
        sweptBySecond_.clear();
    }
    markAnnounced(announced_.keys(), false);
    announced_.clear();
    fewAnnounced_ = kFewAnnounced;
    decide();
    cost_.grid = grid_.endUpdate();
}

template <class Scalar>
void Pairs<Scalar>::sortCouples(std::vector<Couple>& couples) {
    detail::radixSort(couples, static_cast<std::uint32_t>(grid_.records_.size()), sorted_);
}

// A couple is born when its boxes overlap now and did not at the last update.
template <class Scalar>
void Pairs<Scalar>::findBirths(bool someCameToRest, ParallelFor parallelFor) {
    const auto order = grid_.mobile_.order();
    entryOf_.resize(grid_.mobileSlots_.size());
    for (std::uint32_t entry = 0; entry < order.size(); ++entry) {
        entryOf_[order[entry]] = entry;
    }
    carryToRest(someCameToRest);
    joinMobile(parallelFor);
    walkResting(parallelFor);
    if (grid_.areRegrouped_) {
        askAboutRegrouped();
    }
    if (announced_.size() > 0) {
        std::erase_if(asked_, [this](Couple c) { return announced_.contains(c); });
    }
}

// Couples of a mobile one that has not changed and a resting one are not looked for again.
template <class Scalar>
void Pairs<Scalar>::carryToRest(bool someCameToRest) {
    carried_.clear();
    if (grid_.resting_.size() == 0) {
        return;
    }
    const auto isKept = [this](std::uint32_t mobile, std::uint32_t resting) {
        return grid_.records_[resting].place == Grid<Scalar>::Place::resting &&
               grid_.records_[mobile].place == Grid<Scalar>::Place::mobile &&
               !grid_.changedNow(mobile);
    };
    for (const auto [place, slot] : toResting_.pairs()) {
        if (isKept(grid_.mobileSlots_[place], slot)) {
            carried_.push({entryOf_[place], slot});
        }
    }
    if (!someCameToRest) {
        return;
    }
    for (const auto [a, b] : amongMobile_.pairs()) {
        const std::uint32_t slotA = grid_.mobileSlots_[a];
        const std::uint32_t slotB = grid_.mobileSlots_[b];
        if (isKept(slotA, slotB)) {
            carried_.push({entryOf_[a], slotB});
        } else if (isKept(slotB, slotA)) {
            carried_.push({entryOf_[b], slotA});
        }
    }
}

template <class Scalar>
void Pairs<Scalar>::joinMobile(ParallelFor parallelFor) {
    const detail::Table<Scalar>& table = grid_.mobile_;
    detail::KernelCost cost;
    amongMobile_.clear();
    const detail::GroupKinds::Set kinds = grid_.mobileKinds_;
    const bool someRefuse = grid_.groupKinds_.refuse(kinds, kinds);
    const bool areToldApart = someRefuse && isCrowded(table);
    detail::joinTable(table, parallelFor, parts_, amongMobile_, cost,
                      areToldApart ? grid_.groups_.data() : nullptr,
                      grid_.groupKinds_.together(kinds));
    if (someRefuse && !areToldApart) {
        takeOut(amongMobile_, [&](const detail::IndexPair& pair) {
            return doRefuse(table.slot(pair.a), table.slot(pair.b));
        });
    }
    cost_.boxesTested += cost.boxesTested;
    const auto fresh = selectApart(amongMobile_.pairs(), table.order().data(),
                                   grid_.stagedBefore_.data(), parallelFor);
    for (const auto [a, b] : fresh) {
        asked_.push_back(couple(table.slot(a), table.slot(b)));
    }
}

// Those couples of which the boxes, numbered order[a] and order[b], do not overlap; valid until the
// next call.
template <class Scalar>
std::span<const detail::IndexPair> Pairs<Scalar>::selectApart(
    std::span<const detail::IndexPair> couples, const std::uint32_t* order,
    const detail::PaddedBox<Scalar>* boxes, ParallelFor parallelFor) {
    constexpr std::size_t kGrain = 8192;
    selected_.clear();
    detail::KernelCost none;
    const auto select = [&](std::size_t first, std::size_t last, detail::PairSink& sink,
                            detail::KernelCost&) {
        detail::makeRoom(sink, last - first);
        sink.next += detail::kernels<Scalar>().selectApart(couples.data() + first, last - first,
                                                           order, boxes, sink.next);
    };
    parts_.collect(parallelFor, couples.size(), kGrain, selected_, none, select);
    return selected_.pairs();
}

// What changed against the resting proxies.
template <class Scalar>
void Pairs<Scalar>::walkResting(ParallelFor parallelFor) {
    toResting_.swap(carried_);
    if (grid_.resting_.size() == 0) {
        return;
    }
    const detail::Table<Scalar>& table = grid_.mobile_;
    walkers_.clear();
    searchedSlots_.clear();
    bounds_.clear();
    const bool someRefuse = grid_.groupKinds_.refuse(grid_.changedKinds_, grid_.restingKinds_);
    const bool areToldApart = someRefuse && isCrowded(grid_.resting_);
    for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
        const std::uint32_t slot = table.slot(entry);
        if (grid_.changedNow(slot)) {
            walkers_.push_back(entry);
            bounds_.push(table.box(entry));
            if (areToldApart) {
                searchedSlots_.push_back(slot);
            }
        }
    }
    const detail::GroupsView view{grid_.groups_.data(), searchedSlots_.data(),
                                  grid_.groupKinds_.together(grid_.restingKinds_)};
    detail::KernelCost cost;
    selected_.clear();
    detail::walkTable(grid_.resting_, bounds_.columns(), bounds_.size(), parallelFor, parts_,
                      selected_, cost, areToldApart ? &view : nullptr);
    cost_.boxesTested += cost.boxesTested;
    if (someRefuse && !areToldApart) {
        takeOut(selected_, [&](const detail::IndexPair& pair) {
            return doRefuse(table.slot(walkers_[pair.a]), grid_.resting_.slot(pair.b));
        });
    }
    const bool isShifted = !grid_.boxesAtUpdate_.empty();
    for (const auto [walker, restingEntry] : selected_.pairs()) {
        const std::uint32_t entry = walkers_[walker];
        const std::uint32_t slot = grid_.resting_.slot(restingEntry);
        toResting_.push({entry, slot});
        // Not by their slots: these boxes are at hand.
        const detail::PaddedBox<Scalar>& before = grid_.stagedBefore_[table.order()[entry]];
        const Box resting = isShifted ? grid_.boxAtUpdate(slot) : grid_.resting_.box(restingEntry);
        if (!overlaps(detail::unpadded(before), resting)) {
            asked_.push_back(couple(table.slot(entry), slot));
        }
    }
}

template <class Scalar>
bool Pairs<Scalar>::isRefused(Couple c) const noexcept {
    return remembersPairs() ? !isRemembered(c) : refused_.contains(c) || refusedAtRest_.contains(c);
}

template <class Scalar>
bool Pairs<Scalar>::overlapNow(Couple c) const noexcept {
    return overlaps(grid_.standingBox(grid_.records_[first(c)]),
                    grid_.standingBox(grid_.records_[second(c)]));
}

template <class Scalar>
bool Pairs<Scalar>::isAtRest(Couple c) const noexcept {
    return grid_.records_[first(c)].place == Grid<Scalar>::Place::resting &&
           grid_.records_[second(c)].place == Grid<Scalar>::Place::resting;
}

template class Pairs<float>;
template class Pairs<double>;

}  // namespace hashphase
