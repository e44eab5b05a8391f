// SPDX-License-Identifier: Zlib

// What becomes of the candidates that have come to touch, or touch no more: who is a pair, by the filter.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>

namespace hashphase::detail {

// What the filter refused, and is not lost, is asked about again when one of the two has changed, and
// put aside when both have come to rest.
template <class Scalar>
void PairTracker<Scalar>::askRefusedAgain() {
    restedPairs_.clear();
    for (const PairKey c : refused_.keys()) {
        if (!mayPairNow(c)) {
            lapsed_.push_back(c);
        } else if (isAtRest(c)) {
            restedPairs_.push_back(c);
        } else if ((proxies_.changedNow(first(c)) || proxies_.changedNow(second(c))) &&
                   (overlapNow(c) || std::binary_search(sweptNow_.begin(), sweptNow_.end(), c))) {
            asked_.push_back(c);
        }
    }
    for (const PairKey c : restedPairs_) {
        refusedAtRest_.findOrInsert(c);
        refused_.erase(c);
    }
}

// Asks the filter about what is to be asked and has not been asked by this call.
template <class Scalar>
void PairTracker<Scalar>::ask(PairFilter filter) {
    sortPairs(asked_);
    sortPairs(acceptedPairs_);
    askedPairs_.clear();
    const auto numberIfSampled = [this](PairKey c) {
        return pile_ != nullptr ? pile_->sampled.find(c) : FlatSet::kNone;
    };
    for (const PairKey c : asked_) {
        if (mayPairNow(c) && numberIfSampled(c) == FlatSet::kNone) {
            askedPairs_.push_back(pairOf(c));
        }
    }
    accepted_.assign(asked_.size(), 0);
    std::size_t answers = askedPairs_.size();
    {
        const QueryScope scope(&store_, QueryScope::Changes::forbidden);
        filter(askedPairs_, std::span(accepted_).first(answers));
    }
    for (std::size_t i = asked_.size(); i-- > 0 && answers < asked_.size();) {
        const std::uint32_t number = numberIfSampled(asked_[i]);
        if (number != FlatSet::kNone) {
            accepted_[i] = pile_->sampledAccepted[number];
        } else {
            accepted_[i] = mayPairNow(asked_[i]) ? accepted_[--answers] : char{0};
        }
    }
}

// For all that may come of the answers.
template <class Scalar>
void PairTracker<Scalar>::makeRoom(PairChangeLists& lists) {
    const auto refused =
        static_cast<std::size_t>(std::count(accepted_.begin(), accepted_.end(), 0));
    if (remembersPairs()) {
        pile_->pairs.reserve(pile_->pairs.size() + asked_.size());
    } else if (refused > 0) {
        refused_.reserve(refused_.size() + refused);
    }
    if (!newCandidates_.empty()) {
        immediate_.reserve(immediate_.size() + newCandidates_.size(), proxies_.records.size());
    }
    if (!keptNow_.empty()) {
        kept_.reserve(kept_.size() + keptNow_.size());
    }
    const std::size_t mayDie = endedPairs_.size() + acceptedPairs_.size();
    ensureCapacity(begunPairs_, asked_.size());
    ensureCapacity(lists.born, asked_.size());
    ensureCapacity(diedPairs_, mayDie);
    ensureCapacity(lists.died, mayDie);
    ensureCapacity(sorted_, mayDie);
}

// Of what was asked, the standing ones are pairs already. Candidates at rest that are refused are put
// aside by the next update.
template <class Scalar>
void PairTracker<Scalar>::applyFilter() noexcept {  // NOLINT(bugprone-exception-escape)
    std::size_t nextStanding = 0;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
        const PairKey c = asked_[i];
        const bool wasPair =
            nextStanding < acceptedPairs_.size() && acceptedPairs_[nextStanding] == c;
        nextStanding += wasPair ? 1 : 0;
        if (accepted_[i] == 0) {
            if (wasPair) {
                endPair(c);
            }
            if (!remembersPairs() && isToBeRefused(c) && !refusedAtRest_.contains(c)) {
                refused_.findOrInsert(c);
            }
        } else if (!wasPair) {
            if (remembersPairs()) {
                pile_->pairs.findOrInsert(c);
            } else {
                forgetRefused(c);
            }
            begunPairs_.push_back(c);
            ++count_;
        }
    }
}

// What may not pair is not noted down, unless it is known, so that it counts as refused until the next
// update, which forgets it.
template <class Scalar>
bool PairTracker<Scalar>::isToBeRefused(PairKey c) const noexcept {
    return mayPairNow(c) || couldPair(c) || kept_.contains(c) || immediate_.contains(c) ||
           isSwept(c);
}

// Returns whether the candidate was refused.
template <class Scalar>
bool PairTracker<Scalar>::forgetRefused(PairKey c) noexcept {
    return refused_.erase(c) != FlatSet::kNone || refusedAtRest_.erase(c) != FlatSet::kNone;
}

template <class Scalar>
void PairTracker<Scalar>::endPair(PairKey c) noexcept {
    const bool wasPair =
        remembersPairs() ? pile_->pairs.erase(c) != FlatSet::kNone : !forgetRefused(c);
    if (wasPair) {
        diedPairs_.push_back(c);
        --count_;
    }
}

template <class Scalar>
PairChanges PairTracker<Scalar>::report(PairChangeLists& lists) noexcept {
    const auto list = [this](const std::vector<PairKey>& candidates,
                             std::vector<ProxyPair>& pairs) {
        pairs.clear();
        for (const PairKey c : candidates) {
            pairs.push_back(pairOf(c));
        }
    };
    sortPairs(diedPairs_);
    list(begunPairs_, lists.born);  // as sorted as what was asked
    list(diedPairs_, lists.died);
    return {lists.born, lists.died};
}

template void PairTracker<float>::askRefusedAgain();
template void PairTracker<float>::ask(PairFilter);
template void PairTracker<float>::makeRoom(PairChangeLists&);
template void PairTracker<float>::applyFilter() noexcept;
template void PairTracker<float>::endPair(PairKey) noexcept;
template bool PairTracker<float>::isToBeRefused(PairKey) const noexcept;
template bool PairTracker<float>::forgetRefused(PairKey) noexcept;
template PairChanges PairTracker<float>::report(PairChangeLists&) noexcept;
template void PairTracker<double>::askRefusedAgain();
template void PairTracker<double>::ask(PairFilter);
template void PairTracker<double>::makeRoom(PairChangeLists&);
template void PairTracker<double>::applyFilter() noexcept;
template void PairTracker<double>::endPair(PairKey) noexcept;
template bool PairTracker<double>::isToBeRefused(PairKey) const noexcept;
template bool PairTracker<double>::forgetRefused(PairKey) noexcept;
template PairChanges PairTracker<double>::report(PairChangeLists&) noexcept;

}  // namespace hashphase::detail
