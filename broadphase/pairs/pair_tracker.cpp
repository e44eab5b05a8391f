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
        sweeping_->motions.markAllChanged();
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
    for (const PairKey c : kept_.keys()) {
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
    endedPairs_.clear();
    asked_.clear();
    newCandidates_.clear();
    acceptedPairs_.clear();
    if (pile_ != nullptr) {
        pile_->turned.clear();
    }
    keptNow_.clear();
    notKept_.clear();
    lapsed_.clear();
    begunPairs_.clear();
    diedPairs_.clear();
}

// Where memory has run out, everything is mobile, and what the last one has left to be watched
// are the candidates of the boxes at that time.
template <class Scalar>
void PairTracker<Scalar>::recover() {
    if (!store_.mustRebuildPairs) {
        return;
    }
    refused_.reserve(refused_.size() + refusedAtRest_.size());
    tableOfUpdate_ = nullptr;
    store_.stage(serialFor);
    Table<Scalar>& table = wokenTable();
    const ProxyGroups* const groups = proxies_.groupsOfAllAtUpdate();
    table.build(proxies_.mobile, frame_.before, store_.fixedSizes(), serialFor, groups);
    amongMobile_.clear();
    if (!remembersPairs()) {
        KernelCost cost;
        selected_.clear();
        joinTable(table, serialFor, parts_, selected_, cost, groups);
        for (const auto [a, b] : selected_.pairs()) {
            amongMobile_.push({table.order()[a], table.order()[b]});
        }
    }
    for (const PairKey c : refusedAtRest_.keys()) {
        refused_.findOrInsert(c);
    }
    toResting_.clear();
    refusedAtRest_.clear();
    proxies_.woken.clear();
    proxies_.mobileAtUpdate = proxies_.mobile.size();
    tableOfUpdate_ = wokenTable_.get();
    indexedWoken_ = 0;
    shiftOfUpdate_ = store_.shiftCount;
    store_.mustRebuildPairs = false;
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
    makeRoom(updateChanges_);
}

template <class Scalar>
void PairTracker<Scalar>::publish() noexcept {  // NOLINT(bugprone-exception-escape)
    for (const PairKey c : endedPairs_) {
        endPair(c);
        kept_.erase(c);
    }
    for (const PairKey c : keptNow_) {
        kept_.findOrInsert(c);
    }
    for (const PairKey c : notKept_) {
        kept_.erase(c);
    }
    for (const PairKey c : lapsed_) {
        forgetRefused(c);
    }
    if (store_.cost.changed > 0) {
        swept_.swap(sweptNow_);
        tableOfUpdate_ = &tables_.mobile;
        indexedWoken_ = 0;
        filingOfUpdate_ = tables_.filingCount;
        shiftOfUpdate_ = store_.shiftCount;
        sweptBySecond_.clear();
    }
    markImmediate(immediate_.keys(), false);
    immediate_.clear();
    fewImmediate_ = kFewImmediate;
    applyFilter();
}

template <class Scalar>
PairChanges PairTracker<Scalar>::endUpdate(const UpdateCost& cost) noexcept {
    cost_.grid = cost;
    chooseSide(true);
    return report(updateChanges_);
}

template <class Scalar>
void PairTracker<Scalar>::sortPairs(std::vector<PairKey>& candidates) {
    radixSort(candidates, static_cast<std::uint32_t>(proxies_.records.size()), sorted_);
}

template <class Scalar>
bool PairTracker<Scalar>::isRefused(PairKey c) const noexcept {
    return remembersPairs() ? !isRemembered(c) : refused_.contains(c) || refusedAtRest_.contains(c);
}

template class PairTracker<float>;
template class PairTracker<double>;

}  // namespace hashphase::detail
