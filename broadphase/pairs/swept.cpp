// SPDX-License-Identifier: Zlib

// Candidates that touch on their ways.

#include <broadphase/pairs/pair_tracker.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::detail {

// A candidate that has touched on its way and stands and overlaps now, or the other way round, is neither
// lost nor new. What is asked about so far has come to overlap.
template <class Scalar>
void PairTracker<Scalar>::findSwept(ParallelFor parallelFor) {
    std::vector<PairKey>& now = sweptNow_;
    now.clear();
    if (sweeping_ != nullptr) {
        sweeping_->search.find(sweeping_->motions.all, parallelFor);
        now.assign(sweeping_->search.contacts().begin(), sweeping_->search.contacts().end());
    }
    if (now.empty() && swept_.empty()) {
        return;
    }
    if (proxies_.groupsOfAll() != nullptr) {
        leaveOutSweptByGroups();
    }
    std::set_difference(swept_.begin(), swept_.end(), now.begin(), now.end(),
                        std::back_inserter(endedPairs_));
    std::set_difference(now.begin(), now.end(), swept_.begin(), swept_.end(),
                        std::back_inserter(asked_));
    sortPairs(asked_);
    sortPairs(endedPairs_);
    stillEnded_.clear();
    std::set_difference(endedPairs_.begin(), endedPairs_.end(), asked_.begin(), asked_.end(),
                        std::back_inserter(stillEnded_));
    std::erase_if(stillEnded_, [this](PairKey c) {
        return std::binary_search(keptNow_.begin(), keptNow_.end(), c);
    });
    stillBegun_.clear();
    std::set_difference(asked_.begin(), asked_.end(), endedPairs_.begin(), endedPairs_.end(),
                        std::back_inserter(stillBegun_));
    endedPairs_.swap(stillEnded_);
    asked_.swap(stillBegun_);
}

// Of what touches on its way, what may not pair is left out, but for pairs that stand. A pair that met
// on its way, and overlaps now, is kept if need be; one that is swept is not among those that are kept.
template <class Scalar>
void PairTracker<Scalar>::leaveOutSweptByGroups() {
    sortPairs(endedPairs_);
    std::erase_if(sweptNow_, [this](PairKey c) {
        const bool isPair =
            !isRefused(c) &&
            (isSwept(c) || std::binary_search(endedPairs_.begin(), endedPairs_.end(), c));
        return !mayPairNow(c) && !isPair;
    });
    for (const PairKey c : swept_) {
        keepIfPair(c);
    }
    std::sort(keptNow_.begin(), keptNow_.end());
    for (const PairKey c : kept_.keys()) {
        if (std::binary_search(sweptNow_.begin(), sweptNow_.end(), c)) {
            notKept_.push_back(c);
        }
    }
}

template <class Scalar>
bool PairTracker<Scalar>::isSwept(PairKey c) const noexcept {
    return std::binary_search(swept_.begin(), swept_.end(), c);
}

template void PairTracker<float>::findSwept(ParallelFor);
template void PairTracker<float>::leaveOutSweptByGroups();
template bool PairTracker<float>::isSwept(PairKey) const noexcept;
template void PairTracker<double>::findSwept(ParallelFor);
template void PairTracker<double>::leaveOutSweptByGroups();
template bool PairTracker<double>::isSwept(PairKey) const noexcept;

}  // namespace hashphase::detail
