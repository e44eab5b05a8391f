// SPDX-License-Identifier: Zlib
#pragma once

// Which pairs this rank reports.
//
// The grid here has every box that touches this rank's region, and so every pair whose point lies in it. A pair of
// which one box lies wholly in the region has its point there, too: only pairs of two boxes that do not have to
// be looked at.
//
// A pair is born where its boxes overlap now, and did not before: the rank that owns its point now knows both
// boxes now, and both before, which come with new ghosts. It has died where they overlapped before and do not now:
// the rank that owned its point before had both, and is told their boxes now, of what leaves as well.

#include <integration/distributed/rank_grid.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase {

template <class Scalar>
bool RankGrid<Scalar>::isSharedNow(ProxyId id) const noexcept {
    const unsigned marks = marks_[id.index];
    return (marks & kTouched) != 0 ? !liesWithin(boxNow(id)) : (marks & kShared) != 0;
}

// Of what has not been touched it is the box now.
template <class Scalar>
const Aabb<Scalar>& RankGrid<Scalar>::boxBefore(ProxyId id) const noexcept {
    return (marks_[id.index] & kHasBefore) != 0 ? befores_[id.index] : grid_.box(id);
}

// Of what is not removed.
template <class Scalar>
const Aabb<Scalar>& RankGrid<Scalar>::boxNow(ProxyId id) const noexcept {
    return (marks_[id.index] & kRemovedHere) != 0 ? removedHere_[homes_[id.index]].now
                                                  : grid_.box(id);
}

template <class Scalar>
bool RankGrid<Scalar>::ownsPair(const ProxyPair& pair) const noexcept {
    return !isSharedNow(pair.first) || !isSharedNow(pair.second) ||
           partition_.rankOf(pairPoint(boxNow(pair.first), boxNow(pair.second))) == rank_;
}

template <class Scalar>
bool RankGrid<Scalar>::isBornHere(const ProxyPair& pair) const noexcept {
    if (!ownsPair(pair)) {
        return false;
    }
    const unsigned first = marks_[pair.first.index];
    const unsigned second = marks_[pair.second.index];
    if (((first | second) & kNew) == 0) {
        return true;
    }
    // One is new here. What lay wholly in this region did not touch it elsewhere; what was nowhere has NaN.
    constexpr unsigned kMayHaveTouched = kNew | kShared;
    return (first & kMayHaveTouched) == 0 || (second & kMayHaveTouched) == 0 ||
           !overlaps(boxBefore(pair.first), boxBefore(pair.second));
}

template <class Scalar>
bool RankGrid<Scalar>::isDeadHere(const ProxyPair& pair) const noexcept {
    const unsigned first = marks_[pair.first.index];
    const unsigned second = marks_[pair.second.index];
    if ((first & second & kShared) != 0 &&
        lastPartition_.rankOf(pairPoint(boxBefore(pair.first), boxBefore(pair.second))) != rank_) {
        return false;
    }
    return ((first | second) & kRemovedEverywhere) != 0 ||
           !overlaps(boxNow(pair.first), boxNow(pair.second));
}

template <class Scalar>
void RankGrid<Scalar>::reportPairs(const PairChanges& changes) {
    born_.clear();
    died_.clear();
    std::copy_if(changes.born.begin(), changes.born.end(), std::back_inserter(born_),
                 [&](const ProxyPair& pair) { return isBornHere(pair); });
    std::copy_if(changes.died.begin(), changes.died.end(), std::back_inserter(died_),
                 [&](const ProxyPair& pair) { return isDeadHere(pair); });
}

template <class Scalar>
void RankGrid<Scalar>::collectHere(std::vector<ProxyPair>& pairs) const {
    HASHPHASE_ASSERT(isUpToDate(),
                     "RankGrid: pairs were collected after a change. Collect them after finish(), "
                     "before the next change.");
    pairs_.collect(pairs);
    std::erase_if(pairs, [&](const ProxyPair& pair) { return !ownsPair(pair); });
}

template <class Scalar>
void RankGrid<Scalar>::collect(std::vector<GlobalPair>& pairs) const {
    const auto begin = static_cast<std::ptrdiff_t>(pairs.size());
    forEachPair([&](const ProxyPair& pair) { pairs.push_back(globalPair(pair)); });
    std::sort(pairs.begin() + begin, pairs.end());
}

template <class Scalar>
PairSum RankGrid<Scalar>::pairSum() const {
    PairSum sum;
    forEachPair([&](const ProxyPair& pair) { sum.add(globalPair(pair)); });
    return sum;
}

}  // namespace hashphase
