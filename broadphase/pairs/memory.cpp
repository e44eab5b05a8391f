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
           (asked_.capacity() + standing_.capacity() + bornCouples_.capacity() +
            diedCouples_.capacity() + sorted_.capacity() + restedCouples_.capacity() +
            sweptBySecond_.capacity() + lost_.capacity() + swept_.capacity() + gone_.capacity() +
            fresh_.capacity() + unknown_.capacity() + sweptNow_.capacity() +
            stillAnnounced_.capacity() + keptNow_.capacity() + notKept_.capacity() +
            lapsed_.capacity()) *
               sizeof(Couple) +
           (toldByUpdate_.born.capacity() + toldByUpdate_.died.capacity() +
            toldBetween_.born.capacity() + toldBetween_.died.capacity() + askedPairs_.capacity()) *
               sizeof(ProxyPair) +
           accepted_.capacity() + isNamed_.capacity() +
           (entryOf_.capacity() + walkers_.capacity() + searchedSlots_.capacity()) *
               sizeof(std::uint32_t) +
           wokenBoxes_.capacity() * sizeof(PaddedBox<Scalar>) +
           (wokenTable_ != nullptr ? sizeof(*wokenTable_) + wokenTable_->memoryBytes() : 0) +
           announced_.memoryBytes() + kept_.memoryBytes() + refused_.memoryBytes() +
           refusedAtRest_.memoryBytes() + (pile_ != nullptr ? pile_->memoryBytes() : 0);
}

template <class Scalar>
void PairTracker<Scalar>::releaseUnusedMemory() noexcept {
    // What is found anew by each call.
    freeArrays(sweptNow_, lost_, asked_, standing_, askedPairs_, accepted_, bornCouples_,
               diedCouples_, toldByUpdate_.born, toldByUpdate_.died, toldBetween_.born,
               toldBetween_.died, sorted_, restedCouples_, sweptBySecond_, unknown_, gone_, fresh_,
               keptNow_, notKept_, lapsed_, isNamed_, entryOf_, walkers_, searchedSlots_,
               wokenBoxes_);
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
        for (PairList* couples : {&amongMobile_, &toResting_}) {
            couples->shrink();
        }
        for (FlatSet* couples : {&refused_, &refusedAtRest_, &kept_}) {
            couples->shrink();
        }
        announced_.shrink();
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
    // Searches make room for some couples of each proxy.
    const std::size_t count = store_.listedCount() + amongMobile_.size() + toResting_.size() +
                              refusedCount() + announced_.size() +
                              (pile_ != nullptr ? pile_->pairs.size() : 0);
    const std::size_t room = amongMobile_.capacity() + toResting_.capacity() + refused_.capacity() +
                             refusedAtRest_.capacity() + announced_.capacity() +
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
