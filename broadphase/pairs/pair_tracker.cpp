// SPDX-License-Identifier: Zlib
#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/radix_sort.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/search/join.hpp>

namespace hashphase::detail {

template <class Scalar>
PairTracker<Scalar>::PairTracker(Store<Scalar>& store, Sweeping<Scalar>* sweeping)
    : store_(store), sweeping_(sweeping) {
    HASHPHASE_ASSERT(!store_.hasPairs, "A grid has at most one Pairs.");
    store_.forgetLastUpdate();
    store_.hasPairs = true;
}

template <class Scalar>
PairTracker<Scalar>::~PairTracker() {
    store_.endSweeps();
    store_.hasPairs = false;
}

template <class Scalar>
void PairTracker<Scalar>::setSweeps(Sweeping<Scalar>* sweeping) {
    store_.endSweeps();
    sweeping_ = sweeping;
    if (sweeping_ != nullptr) {
        sweeping_->motions.noteAllChanged();
    }
}

// --- An update -----------------------------------------------------------------------------------

template <class Scalar>
void PairTracker<Scalar>::beginUpdate() {
    beginCall();
    cost_ = {};
    releaseAfterPeak();
    recover();
    if (sweeping_ != nullptr) {
        sweeping_->beginUpdate();
    }
    for (const Couple c : kept_.keys()) {
        if (isRefused(c) && !mayPairNow(c)) {  // filtered again
            notKept_.push_back(c);
            lapsed_.push_back(c);
        }
    }
}

template <class Scalar>
void PairTracker<Scalar>::beginCall() {
    if (pile_ != nullptr) {
        pile_->sampled.clear();
        pile_->sampledAccepted.clear();
    }
    beginSearch();
}

template <class Scalar>
void PairTracker<Scalar>::beginSearch() {
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
void PairTracker<Scalar>::recover() {
    if (!store_.isTorn) {
        return;
    }
    refused_.reserve(refused_.size() + refusedAtRest_.size());
    tableOfUpdate_ = nullptr;
    store_.stage(serialFor);
    Table<Scalar>& table = wokenTable();
    const ProxyGroups* const groups = store_.proxies.groupsOfAllAtUpdate();
    table.build(store_.proxies.mobile, store_.frame.before, store_.fixedSizes(), serialFor, groups);
    amongMobile_.clear();
    if (!remembersPairs()) {
        KernelCost cost;
        selected_.clear();
        joinTable(table, serialFor, parts_, selected_, cost, groups);
        for (const auto [a, b] : selected_.pairs()) {
            amongMobile_.push({table.order()[a], table.order()[b]});
        }
    }
    for (const Couple c : refusedAtRest_.keys()) {
        refused_.findOrInsert(c);
    }
    toResting_.clear();
    refusedAtRest_.clear();
    store_.proxies.woken.clear();
    store_.proxies.mobileAtUpdate = store_.proxies.mobile.size();
    tableOfUpdate_ = wokenTable_.get();
    indexedWoken_ = 0;
    shiftOfUpdate_ = store_.shiftCount;
    store_.isTorn = false;
}

template <class Scalar>
void PairTracker<Scalar>::rememberInstead() {
    beginSearch();
    store_.wakeAll();
    recover();
    rememberPairs();
}

template <class Scalar>
void PairTracker<Scalar>::askAndMakeRoom(PairFilter filter) {
    if (!remembersPairs()) {
        ask(filter);
    }
    makeRoom(toldByUpdate_);
}

template <class Scalar>
void PairTracker<Scalar>::publish() noexcept {  // NOLINT(bugprone-exception-escape)
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
    if (store_.cost.changed > 0) {
        swept_.swap(sweptNow_);
        tableOfUpdate_ = &store_.tables.mobile;
        indexedWoken_ = 0;
        filingOfUpdate_ = store_.tables.filingCount;
        shiftOfUpdate_ = store_.shiftCount;
        sweptBySecond_.clear();
    }
    markAnnounced(announced_.keys(), false);
    announced_.clear();
    fewAnnounced_ = kFewAnnounced;
    decide();
}

template <class Scalar>
PairChanges PairTracker<Scalar>::endUpdate(const UpdateCost& cost) noexcept {
    cost_.grid = cost;
    chooseSide(true);
    return tell(toldByUpdate_);
}

template <class Scalar>
void PairTracker<Scalar>::sortCouples(std::vector<Couple>& couples) {
    radixSort(couples, static_cast<std::uint32_t>(store_.proxies.records.size()), sorted_);
}

template <class Scalar>
bool PairTracker<Scalar>::isRefused(Couple c) const noexcept {
    return remembersPairs() ? !isRemembered(c) : refused_.contains(c) || refusedAtRest_.contains(c);
}

template class PairTracker<float>;
template class PairTracker<double>;

}  // namespace hashphase::detail
