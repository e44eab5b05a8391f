// SPDX-License-Identifier: Zlib

// What Pairs hold, and what they give back after a peak.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <new>

namespace hashphase::detail {

template <class Scalar>
std::size_t PairTracker<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + amongMobile_.memoryBytes() + toResting_.memoryBytes() +
           selected_.memoryBytes() + parts_.memoryBytes() + carried_.memoryBytes() +
           bounds_.memoryBytes() +
           (asked_.capacity() + acceptedPairs_.capacity() + begunPairs_.capacity() +
            diedPairs_.capacity() + sorted_.capacity() + restedPairs_.capacity() +
            sweptBySecond_.capacity() + endedPairs_.capacity() + swept_.capacity() +
            stillEnded_.capacity() + stillBegun_.capacity() + newCandidates_.capacity() +
            sweptNow_.capacity() + stillImmediate_.capacity() + keptNow_.capacity() +
            notKept_.capacity() + lapsed_.capacity()) *
               sizeof(PairKey) +
           (updateChanges_.born.capacity() + updateChanges_.died.capacity() +
            immediateChanges_.born.capacity() + immediateChanges_.died.capacity() +
            askedPairs_.capacity()) *
               sizeof(ProxyPair) +
           accepted_.capacity() + isNamed_.capacity() +
           (entryOf_.capacity() + changedEntries_.capacity() + searchedIndices_.capacity()) *
               sizeof(std::uint32_t) +
           wokenBoxes_.capacity() * sizeof(PaddedBox<Scalar>) +
           (wokenTable_ != nullptr ? sizeof(*wokenTable_) + wokenTable_->memoryBytes() : 0) +
           immediate_.memoryBytes() + kept_.memoryBytes() + refused_.memoryBytes() +
           refusedAtRest_.memoryBytes() + (pile_ != nullptr ? pile_->memoryBytes() : 0);
}

template <class Scalar>
void PairTracker<Scalar>::releaseUnusedMemory() noexcept {
    // What is found anew by each call.
    freeArrays(sweptNow_, endedPairs_, asked_, acceptedPairs_, askedPairs_, accepted_, begunPairs_,
               diedPairs_, updateChanges_.born, updateChanges_.died, immediateChanges_.born,
               immediateChanges_.died, sorted_, restedPairs_, sweptBySecond_, newCandidates_,
               stillEnded_, stillBegun_, keptNow_, notKept_, lapsed_, isNamed_, entryOf_,
               changedEntries_, searchedIndices_, wokenBoxes_);
    selected_ = {};
    parts_ = {};
    carried_ = {};
    bounds_ = {};
    tableOfUpdate_ = tableOfUpdate_ == wokenTable_.get() ? nullptr : tableOfUpdate_;
    wokenTable_.reset();
    if (!remembersPairs()) {
        pile_.reset();
    }
    // What is kept.
    swept_.shrink_to_fit();
    try {
        for (PairList* candidates : {&amongMobile_, &toResting_}) {
            candidates->shrink();
        }
        for (FlatSet* candidates : {&refused_, &refusedAtRest_, &kept_}) {
            candidates->shrink();
        }
        immediate_.shrink();
        if (pile_ != nullptr) {
            freeArrays(pile_->turned, pile_->sampledAccepted);
            pile_->sampled = {};
            pile_->pairs.shrink();
        }
    } catch (const std::bad_alloc&) {  // what is left is kept as it is
    }
}

template <class Scalar>
void PairTracker<Scalar>::releaseAfterPeak() noexcept {
    // Searches make room for some candidates of each proxy.
    const std::size_t count = store_.listedCount() + amongMobile_.size() + toResting_.size() +
                              refusedCount() + immediate_.size() +
                              (pile_ != nullptr ? pile_->pairs.size() : 0);
    const std::size_t room = amongMobile_.capacity() + toResting_.capacity() + refused_.capacity() +
                             refusedAtRest_.capacity() + immediate_.capacity() +
                             (pile_ != nullptr ? pile_->pairs.capacity() : 0);
    if (peaks_.isPast(count, room)) {
        releaseUnusedMemory();
    }
}

template std::size_t PairTracker<float>::memoryBytes() const noexcept;
template void PairTracker<float>::releaseUnusedMemory() noexcept;
template void PairTracker<float>::releaseAfterPeak() noexcept;
template std::size_t PairTracker<double>::memoryBytes() const noexcept;
template void PairTracker<double>::releaseUnusedMemory() noexcept;
template void PairTracker<double>::releaseAfterPeak() noexcept;

}  // namespace hashphase::detail
