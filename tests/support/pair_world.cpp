// SPDX-License-Identifier: Zlib
#include <tests/support/pair_world.hpp>

#include <tests/support/motion_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace hashphase::test {
namespace {

bool isAscending(std::span<const ProxyPair> list) {
    return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
}

template <class Scalar>
bool isRoundedBy(const Vector3<Scalar>& shift, const Aabb<Scalar>& box) {
    bool isRounded = false;
    for (const auto* corner : {&box.min(), &box.max()}) {
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar x = (*corner)[axis];
            const Scalar difference = x - shift[axis];
            const bool isExact = std::isfinite(difference) &&
                                 mpq_class(x) - mpq_class(shift[axis]) == mpq_class(difference);
            isRounded = isRounded || (!isExact && std::isfinite(x) && x - 2 * shift[axis] != x);
        }
    }
    return isRounded && !hasNan(box);
}

}  // namespace

template <class Scalar>
void PairWorld<Scalar>::move(ProxyId id, const Aabb<Scalar>& box) {
    const Aabb<Scalar> present = grid.box(id);
    if (std::memcmp(&present, &box, sizeof(box)) != 0) {
        changed_.insert(id);
    }
    grid.move(id, box);
}

template <class Scalar>
void PairWorld<Scalar>::remove(ProxyId id) {
    grid.remove(id);
    ways_.erase(id);
    groups_.erase(id);
    std::erase_if(ignored_,
                  [id](const ProxyPair& pair) { return pair.first == id || pair.second == id; });
}

template <class Scalar>
void PairWorld<Scalar>::setGroups(ProxyId id, const ProxyGroups& groups) {
    if (!(groupsOf(id) == groups)) {
        changed_.insert(id);
    }
    groups_[id] = groups;
    grid.setGroups(id, groups);
    EXPECT_TRUE(grid.groups(id) == groups);
}

template <class Scalar>
void PairWorld<Scalar>::renewSweeps(bool areThere) {
    pairs.setSweeps(nullptr);
    std::destroy_at(&sweeps);
    std::construct_at(&sweeps, grid);
    pairs.setSweeps(areThere ? &sweeps : nullptr);
    for (const auto& [id, way] : ways_) {
        changed_.insert(id);
    }
    ways_.clear();
}

template <class Scalar>
void PairWorld<Scalar>::shiftOrigin(const Vector3<Scalar>& shift) {
    std::size_t count = 0;
    grid.forEach([&](ProxyId id, const Aabb<Scalar>& box) {
        if (isRoundedBy(shift, box)) {
            ++count;
            changed_.insert(id);
        }
    });
    ASSERT_EQ(grid.shiftOrigin(shift), count);
    for (auto& [id, way] : ways_) {
        if (way.box) {
            way.box = Aabb<Scalar>(way.box->min() - shift, way.box->max() - shift);
        }
    }
}

template <class Scalar>
void PairWorld<Scalar>::renewPairs(bool withUpdateBetween) {
    std::destroy_at(&pairs);
    if (withUpdateBetween) {
        grid.update();
    }
    std::construct_at(&pairs, grid, &sweeps);
    forgetPairs();
    grid.forEach([this](ProxyId id, const Aabb<Scalar>& /*box*/) { changed_.insert(id); });
}

template <class Scalar>
void PairWorld<Scalar>::clear() {
    pairs.clear();
    forgetPairs();
    changed_.clear();
    ways_.clear();
}

template <class Scalar>
typename PairWorld<Scalar>::Filter PairWorld<Scalar>::recordingFilter() {
    return [this](ProxyId a, ProxyId b) {
        EXPECT_TRUE(grid.contains(a) && grid.contains(b)) << "the filter is asked about the dead";
        EXPECT_TRUE(mayBeAsked(makePair(a, b))) << "the filter is asked where it does not decide";
        asked_.push_back({a, b});
        return filter_(a, b);
    };
}

template <class Scalar>
void PairWorld<Scalar>::refilter(ProxyId id) {
    asked_.clear();
    noteRefiltered(pairs.refilter(id, recordingFilter()));
}

template <class Scalar>
void PairWorld<Scalar>::refilter(std::span<const ProxyId> ids) {
    asked_.clear();
    noteRefiltered(pairs.refilter(ids, recordingFilter()));
}

template <class Scalar>
void PairWorld<Scalar>::refilterAll() {
    asked_.clear();
    noteRefiltered(pairs.refilterAll(recordingFilter()));
}

template <class Scalar>
void PairWorld<Scalar>::findPairsNow(ProxyId id) {
    asked_.clear();
    const PairChanges changes = pairs.findPairsNow(id, recordingFilter());
    for (const ProxyPair& pair : asked_) {
        EXPECT_TRUE(askedNow_.insert(pair).second)
            << testing::PrintToString(pair) << " is asked about twice";
    }
    for (const ProxyPair& pair : changes.died) {
        EXPECT_FALSE(grid.contains(pair.first) && grid.contains(pair.second))
            << testing::PrintToString(pair) << " dies though both are alive";
    }
    apply(changes);
    noteDecided();
    noteAsked("findPairsNow");
}

template <class Scalar>
void PairWorld<Scalar>::ignore(const ProxyPair& pair) {
    if (set_.contains(pair)) {
        refused_.insert(pair);
    }
    asked_.clear();
    ignored_.insert(pair);
    apply(pairs.ignore(pair));
    EXPECT_FALSE(set_.contains(pair)) << testing::PrintToString(pair) << " is ignored and a pair";
    expectIgnored();
}

// The two are a pair at once, unless one of them sweeps.
template <class Scalar>
void PairWorld<Scalar>::stopIgnoring(const ProxyPair& pair) {
    const bool wasIgnored = ignored_.erase(pair) > 0;
    asked_.clear();
    apply(pairs.stopIgnoring(pair, recordingFilter()));
    if (!wasIgnored) {
        EXPECT_TRUE(asked_.empty());
    } else if (!doesSweep(pair.first) && !doesSweep(pair.second)) {
        const bool isPair = overlaps(grid.box(pair.first), grid.box(pair.second)) &&
                            mayPair(pair) && filter_(pair.first, pair.second);
        EXPECT_EQ(set_.contains(pair), isPair) << testing::PrintToString(pair);
    }
    noteDecided();
    expectIgnored();
}

template <class Scalar>
PairChanges PairWorld<Scalar>::update() {
    asked_.clear();
    askedNow_.clear();
    before_ = set_;
    const bool wasUpToDate = pairs.isUpToDate();
    const PairChanges changes = pairs.update(recordingFilter());
    EXPECT_TRUE(!wasUpToDate || (changes.born.empty() && changes.died.empty() && asked_.empty()));
    apply(changes);
    noteAsked("update");
    return changes;
}

template <class Scalar>
void PairWorld<Scalar>::check(std::span<const Placed<Scalar>> proxies) {
    const std::vector<ProxyPair> expected =
        pairsByBruteForce(proxies, [this](const Placed<Scalar>& a, const Placed<Scalar>& b) {
            const ProxyPair pair = makePair(a.id, b.id);
            return doMeet(a, b) && !ignored_.contains(pair) &&
                   (mayPair(pair) || before_.contains(pair));
        });
    const std::vector<ProxyPair> actual(set_.begin(), set_.end());
    ASSERT_EQ(differences(actual, expected), "");
    ASSERT_EQ(pairs.count(), expected.size());
    std::vector<ProxyPair> collected;
    pairs.collect(collected);
    ASSERT_EQ(differences(collected, expected), "");
}

template <class Scalar>
void PairWorld<Scalar>::checkThoroughly(std::span<const Placed<Scalar>> proxies) {
    ASSERT_NO_FATAL_FAILURE(check(proxies));
    ASSERT_EQ(grid.validate(), "");
    ASSERT_EQ(sweeps.validate(), "");
    ASSERT_EQ(pairs.validate(), "");
    checkAsked(proxies);
}

template <class Scalar>
void PairWorld<Scalar>::apply(const PairChanges& changes) {
    ASSERT_TRUE(isAscending(changes.born)) << "births are sorted, each once";
    ASSERT_TRUE(isAscending(changes.died)) << "deaths are sorted, each once";
    for (const ProxyPair& pair : changes.died) {
        ASSERT_EQ(set_.erase(pair), 1U) << testing::PrintToString(pair) << " dies but was no pair";
        ASSERT_FALSE(std::binary_search(changes.born.begin(), changes.born.end(), pair))
            << testing::PrintToString(pair) << " is born and dies at once";
    }
    for (const ProxyPair& pair : changes.born) {
        ASSERT_TRUE(set_.insert(pair).second)
            << testing::PrintToString(pair) << " is born but was a pair";
        ASSERT_LT(pair.first.index, pair.second.index);
    }
}

template <class Scalar>
void PairWorld<Scalar>::forgetPairs() {
    for (auto* of : {&set_, &met_, &refused_, &decided_, &before_, &askedNow_, &ignored_}) {
        of->clear();
    }
}

template <class Scalar>
void PairWorld<Scalar>::noteWay(ProxyId id, const Way& way, Sweep mode) {
    if (mode != Sweep::none && way.displacement.allFinite() && !way.displacement.isZero(0)) {
        ways_[id] = way;
    } else if (ways_.erase(id) > 0) {
        changed_.insert(id);
    }
}

// More may be asked about in parts.
template <class Scalar>
void PairWorld<Scalar>::noteAsked(const char* what) {
    constexpr std::size_t kPart = 2048;
    if (asked_.size() > kPart) {
        std::sort(asked_.begin(), asked_.end());
    }
    EXPECT_TRUE(isAscending(asked_)) << what << " asks in ascending order, each pair once";
}

// Pairs that may not be any more by their groups end without a question.
template <class Scalar>
void PairWorld<Scalar>::noteRefiltered(const PairChanges& changes) {
    refused_.insert(changes.died.begin(), changes.died.end());
    apply(changes);
    noteDecided();
    noteAsked("refilter");
}

// What was asked before the update needs not be asked by it.
template <class Scalar>
void PairWorld<Scalar>::noteDecided() {
    for (const ProxyPair& pair : asked_) {
        decided_.insert(pair);
        if (filter_(pair.first, pair.second)) {
            refused_.erase(pair);
        } else {
            refused_.insert(pair);
        }
    }
}

template <class Scalar>
bool PairWorld<Scalar>::doMeet(const Placed<Scalar>& a, const Placed<Scalar>& b) const {
    if (!doesSweep(a.id) && !doesSweep(b.id)) {
        return overlaps(a.box, b.box);
    }
    const MovingBox<Scalar> wayOfA = motion(a);
    const MovingBox<Scalar> wayOfB = motion(b);
    return overlaps(wayOfA.box, wayOfB.box) || firstContactByRationals(wayOfA, wayOfB).has_value();
}

// Asked must be: pairs that may pair and meet now and did not before, or could not, unless decided
// already, and refused ones that still meet and of which one has changed.
template <class Scalar>
void PairWorld<Scalar>::checkAsked(std::span<const Placed<Scalar>> proxies) {
    std::set<ProxyPair> meeting;
    std::vector<ProxyPair> expected;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1; j < proxies.size(); ++j) {
            if (!doMeet(proxies[i], proxies[j])) {
                continue;
            }
            const ProxyPair pair = makePair(proxies[i].id, proxies[j].id);
            if (!mayPair(pair) && !set_.contains(pair)) {
                continue;
            }
            meeting.insert(pair);
            if (!mayBeAsked(pair)) {
                continue;  // ignored, or a pair as long as they meet
            }
            const bool isNew = !met_.contains(pair) && !decided_.contains(pair);
            const bool isRefused = refused_.contains(pair) && hasChanged(pair);
            if (isNew || isRefused) {
                expected.push_back(pair);
            }
        }
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(differences(asked_, expected), "") << "asked";
    refused_.clear();
    std::set_difference(meeting.begin(), meeting.end(), set_.begin(), set_.end(),
                        std::inserter(refused_, refused_.end()));
    ASSERT_EQ(pairs.refusedCount(), pairs.remembersPairs() ? 0U : refused_.size());
    met_.swap(meeting);
    decided_.clear();
    changed_.clear();
}

template <class Scalar>
bool PairWorld<Scalar>::hasChanged(const ProxyPair& pair) const {
    return changed_.contains(pair.first) || changed_.contains(pair.second) ||
           ways_.contains(pair.first) || ways_.contains(pair.second);
}

template <class Scalar>
ProxyGroups PairWorld<Scalar>::groupsOf(ProxyId id) const {
    const auto groups = groups_.find(id);
    return groups != groups_.end() ? groups->second : ProxyGroups{};
}

template <class Scalar>
bool PairWorld<Scalar>::mayPair(const ProxyPair& pair) const {
    return hashphase::mayPair(groupsOf(pair.first), groupsOf(pair.second));
}

template <class Scalar>
bool PairWorld<Scalar>::mayBeAsked(const ProxyPair& pair) const {
    return mayPair(pair) && !ignored_.contains(pair);
}

template <class Scalar>
void PairWorld<Scalar>::expectIgnored() const {
    std::vector<ProxyPair> all;
    pairs.collectIgnored(all);
    EXPECT_TRUE(std::ranges::equal(all, ignored_));
    for (const ProxyPair& pair : all) {
        EXPECT_TRUE(pairs.isIgnored({pair.second, pair.first}));
    }
}

template class PairWorld<float>;
template class PairWorld<double>;

}  // namespace hashphase::test
