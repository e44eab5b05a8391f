// SPDX-License-Identifier: Zlib

// What becomes of the couples that have come to touch, or touch no more: who is a pair, by the filter.

#include <broadphase/pairs/pair_tracker.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>

namespace hashphase::detail {

// What the filter refused, and is not lost, is asked about again when one of the two has changed, and
// put aside when both have come to rest.
template <class Scalar>
void PairTracker<Scalar>::askRefusedAgain() {
    restedCouples_.clear();
    for (const Couple c : refused_.keys()) {
        if (!mayPairNow(c)) {
            lapsed_.push_back(c);
        } else if (isAtRest(c)) {
            restedCouples_.push_back(c);
        } else if ((store_.proxies.changedNow(first(c)) || store_.proxies.changedNow(second(c))) &&
                   (overlapNow(c) || std::binary_search(sweptNow_.begin(), sweptNow_.end(), c))) {
            asked_.push_back(c);
        }
    }
    for (const Couple c : restedCouples_) {
        refusedAtRest_.findOrInsert(c);
        refused_.erase(c);
    }
}

// Asks the filter about what is to be asked and has not been asked by this call.
template <class Scalar>
void PairTracker<Scalar>::ask(PairFilter filter) {
    sortCouples(asked_);
    sortCouples(standing_);
    askedPairs_.clear();
    const auto numberIfSampled = [this](Couple c) {
        return pile_ != nullptr ? pile_->sampled.find(c) : FlatSet::kNone;
    };
    for (const Couple c : asked_) {
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
void PairTracker<Scalar>::makeRoom(Told& told) {
    const auto refused =
        static_cast<std::size_t>(std::count(accepted_.begin(), accepted_.end(), 0));
    if (remembersPairs()) {
        pile_->pairs.reserve(pile_->pairs.size() + asked_.size());
    } else if (refused > 0) {
        refused_.reserve(refused_.size() + refused);
    }
    if (!unknown_.empty()) {
        announced_.reserve(announced_.size() + unknown_.size(), store_.proxies.records.size());
    }
    if (!keptNow_.empty()) {
        kept_.reserve(kept_.size() + keptNow_.size());
    }
    const std::size_t mayDie = lost_.size() + standing_.size();
    ensureCapacity(bornCouples_, asked_.size());
    ensureCapacity(told.born, asked_.size());
    ensureCapacity(diedCouples_, mayDie);
    ensureCapacity(told.died, mayDie);
    ensureCapacity(sorted_, mayDie);
}

// Of what was asked, the standing ones are pairs already. Couples at rest that are refused are put
// aside by the next update.
template <class Scalar>
void PairTracker<Scalar>::decide() noexcept {  // NOLINT(bugprone-exception-escape)
    std::size_t nextStanding = 0;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
        const Couple c = asked_[i];
        const bool wasPair = nextStanding < standing_.size() && standing_[nextStanding] == c;
        nextStanding += wasPair ? 1 : 0;
        if (accepted_[i] == 0) {
            if (wasPair) {
                lose(c);
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
            bornCouples_.push_back(c);
            ++count_;
        }
    }
}

// What may not pair is not noted down, unless it is known, so that it counts as refused until the next
// update, which forgets it.
template <class Scalar>
bool PairTracker<Scalar>::isToBeRefused(Couple c) const noexcept {
    return mayPairNow(c) || couldPair(c) || kept_.contains(c) || announced_.contains(c) ||
           isSwept(c);
}

// Returns whether the couple was refused.
template <class Scalar>
bool PairTracker<Scalar>::forgetRefused(Couple c) noexcept {
    return refused_.erase(c) != FlatSet::kNone || refusedAtRest_.erase(c) != FlatSet::kNone;
}

template <class Scalar>
void PairTracker<Scalar>::lose(Couple c) noexcept {
    const bool wasPair =
        remembersPairs() ? pile_->pairs.erase(c) != FlatSet::kNone : !forgetRefused(c);
    if (wasPair) {
        diedCouples_.push_back(c);
        --count_;
    }
}

template <class Scalar>
PairChanges PairTracker<Scalar>::tell(Told& told) noexcept {
    const auto list = [this](const std::vector<Couple>& couples, std::vector<ProxyPair>& pairs) {
        pairs.clear();
        for (const Couple c : couples) {
            pairs.push_back(pairOf(c));
        }
    };
    sortCouples(diedCouples_);
    list(bornCouples_, told.born);  // as sorted as what was asked
    list(diedCouples_, told.died);
    return {told.born, told.died};
}

template void PairTracker<float>::askRefusedAgain();
template void PairTracker<float>::ask(PairFilter);
template void PairTracker<float>::makeRoom(Told&);
template void PairTracker<float>::decide() noexcept;
template void PairTracker<float>::lose(Couple) noexcept;
template bool PairTracker<float>::isToBeRefused(Couple) const noexcept;
template bool PairTracker<float>::forgetRefused(Couple) noexcept;
template PairChanges PairTracker<float>::tell(Told&) noexcept;
template void PairTracker<double>::askRefusedAgain();
template void PairTracker<double>::ask(PairFilter);
template void PairTracker<double>::makeRoom(Told&);
template void PairTracker<double>::decide() noexcept;
template void PairTracker<double>::lose(Couple) noexcept;
template bool PairTracker<double>::isToBeRefused(Couple) const noexcept;
template bool PairTracker<double>::forgetRefused(Couple) noexcept;
template PairChanges PairTracker<double>::tell(Told&) noexcept;

}  // namespace hashphase::detail
