// SPDX-License-Identifier: Zlib
#pragma once

// A grid and its pairs, watched: what the changes report is applied to a set of pairs, and every
// promise about the changes is checked on the way.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/motion_oracle.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Grid, Sweeps and Pairs, and the set of pairs as a client would keep it. A World for scripts.
template <class Scalar>
class PairWorld {
public:
    using Filter = std::function<bool(ProxyId, ProxyId)>;

    /// Colours decide which pairs are accepted, unless a filter is given.
    explicit PairWorld(const GridConfig& config = {}, Filter filter = {})
        : grid(config), sweeps(grid), pairs(grid, &sweeps), filter_(std::move(filter)) {
        if (!filter_) {
            filter_ = [this](ProxyId a, ProxyId b) { return colours.accept(a, b); };
        }
    }

    ProxyId add(const Aabb<Scalar>& box, Mobility mobility = Mobility::mobile) {
        const ProxyId id = grid.add(box, mobility);
        colours.set(id, 0);
        changed_.insert(id);
        return id;
    }
    void move(ProxyId id, const Aabb<Scalar>& box) {
        const Aabb<Scalar> present = grid.box(id);
        if (std::memcmp(&present, &box, sizeof(box)) != 0) {
            changed_.insert(id);
        }
        grid.move(id, box);
    }
    void remove(ProxyId id) {
        grid.remove(id);
        ways_.erase(id);
        groups_.erase(id);
    }
    void setGroups(ProxyId id, const ProxyGroups& groups) {
        if (!(groupsOf(id) == groups)) {
            changed_.insert(id);
        }
        groups_[id] = groups;
        grid.setGroups(id, groups);
        EXPECT_TRUE(grid.groups(id) == groups);
    }
    void sweep(ProxyId id, const Vector3<Scalar>& displacement, Sweep mode) {
        sweeps.set(id, displacement, mode);
        noteWay(id, {std::nullopt, displacement}, mode);
    }
    /// The same from a box of its own.
    void sweep(ProxyId id, const MovingBox<Scalar>& way, Sweep mode) {
        sweeps.set(id, way, mode);
        noteWay(id, {way.box, way.displacement}, mode);
    }
    /// Gives the pairs other sweeps, or none: what swept does so no more.
    void renewSweeps(bool areThere) {
        pairs.setSweeps(nullptr);
        std::destroy_at(&sweeps);
        std::construct_at(&sweeps, grid);
        pairs.setSweeps(areThere ? &sweeps : nullptr);
        for (const auto& [id, way] : ways_) {
            changed_.insert(id);
        }
        ways_.clear();
    }
    [[nodiscard]] bool doesSweep(ProxyId id) const { return ways_.contains(id); }
    [[nodiscard]] MovingBox<Scalar> motion(const Placed<Scalar>& proxy) const {
        const auto way = ways_.find(proxy.id);
        return way == ways_.end() ? MovingBox<Scalar>{proxy.box}
                                  : MovingBox<Scalar>{way->second.box.value_or(proxy.box),
                                                      way->second.displacement};
    }

    /// Shifts the origin, and notes whose boxes that changes, as Grid::shiftOrigin() says.
    void shiftOrigin(const Vector3<Scalar>& shift) {
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

    /// Gives the grid other pairs, for which everybody is new; before that it may have none for an update.
    void renewPairs(bool withUpdateBetween) {
        std::destroy_at(&pairs);
        if (withUpdateBetween) {
            grid.update();
        }
        std::construct_at(&pairs, grid, &sweeps);
        forgetPairs();
        grid.forEach([this](ProxyId id, const Aabb<Scalar>& /*box*/) { changed_.insert(id); });
    }

    /// Removes every proxy, and nothing is reported of any pair.
    void clear() {
        pairs.clear();
        forgetPairs();
        changed_.clear();
        ways_.clear();
    }

    void refilter(ProxyId id) {
        asked_.clear();
        noteRefiltered(pairs.refilter(id, recordingFilter()));
    }
    void refilter(std::span<const ProxyId> ids) {
        asked_.clear();
        noteRefiltered(pairs.refilter(ids, recordingFilter()));
    }
    void refilterAll() {
        asked_.clear();
        noteRefiltered(pairs.refilterAll(recordingFilter()));
    }

    void findPairsNow(ProxyId id) {
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

    /// Ends the frame. What the filter was asked is in asked() afterwards.
    PairChanges update() {
        asked_.clear();
        askedNow_.clear();
        before_ = set_;
        const PairChanges changes = pairs.update(recordingFilter());
        apply(changes);
        noteAsked("update");
        return changes;
    }

    /// To be called after update(): the pairs are those of brute force, and all accounts agree.
    void check(std::span<const Placed<Scalar>> proxies) {
        const std::vector<ProxyPair> expected =
            pairsByBruteForce(proxies, [this](const Placed<Scalar>& a, const Placed<Scalar>& b) {
                const ProxyPair pair = makePair(a.id, b.id);
                return doMeet(a, b) && (mayPair(pair) || before_.contains(pair));
            });
        const std::vector<ProxyPair> actual(set_.begin(), set_.end());
        ASSERT_EQ(differences(actual, expected), "");
        ASSERT_EQ(pairs.count(), expected.size());
        std::vector<ProxyPair> collected;
        pairs.collect(collected);
        ASSERT_EQ(differences(collected, expected), "");
    }

    /// Invariants, and that the filter was asked what it had to be and nothing else.
    void checkThoroughly(std::span<const Placed<Scalar>> proxies) {
        ASSERT_NO_FATAL_FAILURE(check(proxies));
        ASSERT_EQ(grid.validate(), "");
        ASSERT_EQ(sweeps.validate(), "");
        ASSERT_EQ(pairs.validate(), "");
        checkAsked(proxies);
    }

    [[nodiscard]] const std::set<ProxyPair>& set() const noexcept { return set_; }
    [[nodiscard]] const std::vector<ProxyPair>& asked() const noexcept { return asked_; }

    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps;
    Pairs<Scalar> pairs;
    Colours colours;

    /// What a call on `pairs` itself reports.
    void apply(const PairChanges& changes) {
        ASSERT_TRUE(isAscending(changes.born)) << "births are sorted, each once";
        ASSERT_TRUE(isAscending(changes.died)) << "deaths are sorted, each once";
        for (const ProxyPair& pair : changes.died) {
            ASSERT_EQ(set_.erase(pair), 1U)
                << testing::PrintToString(pair) << " dies but was no pair";
            ASSERT_FALSE(std::binary_search(changes.born.begin(), changes.born.end(), pair))
                << testing::PrintToString(pair) << " is born and dies at once";
        }
        for (const ProxyPair& pair : changes.born) {
            ASSERT_TRUE(set_.insert(pair).second)
                << testing::PrintToString(pair) << " is born but was a pair";
            ASSERT_LT(pair.first.index, pair.second.index);
        }
    }

private:
    struct Way {
        std::optional<Aabb<Scalar>> box;  // none where it begins at the proxy's box
        Vector3<Scalar> displacement;
    };

    void forgetPairs() {
        for (auto* of : {&set_, &met_, &refused_, &decided_, &before_, &askedNow_}) {
            of->clear();
        }
    }

    void noteWay(ProxyId id, const Way& way, Sweep mode) {
        if (mode != Sweep::none && way.displacement.allFinite() && !way.displacement.isZero(0)) {
            ways_[id] = way;
        } else if (ways_.erase(id) > 0) {
            changed_.insert(id);
        }
    }

    auto recordingFilter() {
        return [this](ProxyId a, ProxyId b) {
            EXPECT_TRUE(grid.contains(a) && grid.contains(b))
                << "the filter is asked about the dead";
            EXPECT_TRUE(mayPair(makePair(a, b))) << "the filter is asked where groups decide";
            asked_.push_back({a, b});
            return filter_(a, b);
        };
    }

    static bool isRoundedBy(const Vector3<Scalar>& shift, const Aabb<Scalar>& box) {
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

    // More may be asked about in parts.
    void noteAsked(const char* what) {
        constexpr std::size_t kPart = 2048;
        if (asked_.size() > kPart) {
            std::sort(asked_.begin(), asked_.end());
        }
        EXPECT_TRUE(isAscending(asked_)) << what << " asks in ascending order, each pair once";
    }

    static bool isAscending(std::span<const ProxyPair> list) {
        return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
    }

    [[nodiscard]] ProxyGroups groupsOf(ProxyId id) const {
        const auto groups = groups_.find(id);
        return groups != groups_.end() ? groups->second : ProxyGroups{};
    }
    [[nodiscard]] bool mayPair(const ProxyPair& pair) const {
        return hashphase::mayPair(groupsOf(pair.first), groupsOf(pair.second));
    }

    // Pairs that may not be any more by their groups end without a question.
    void noteRefiltered(const PairChanges& changes) {
        refused_.insert(changes.died.begin(), changes.died.end());
        apply(changes);
        noteDecided();
        noteAsked("refilter");
    }

    // What was asked before the update needs not be asked by it.
    void noteDecided() {
        for (const ProxyPair& pair : asked_) {
            decided_.insert(pair);
            if (filter_(pair.first, pair.second)) {
                refused_.erase(pair);
            } else {
                refused_.insert(pair);
            }
        }
    }

    [[nodiscard]] bool doMeet(const Placed<Scalar>& a, const Placed<Scalar>& b) const {
        if (!doesSweep(a.id) && !doesSweep(b.id)) {
            return overlaps(a.box, b.box);
        }
        const MovingBox<Scalar> wayOfA = motion(a);
        const MovingBox<Scalar> wayOfB = motion(b);
        return overlaps(wayOfA.box, wayOfB.box) ||
               firstContactByRationals(wayOfA, wayOfB).has_value();
    }

    // Asked must be: pairs that may pair and meet now and did not before, or could not, unless decided
    // already, and refused ones that still meet and of which one has changed.
    void checkAsked(std::span<const Placed<Scalar>> proxies) {
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
                if (!mayPair(pair)) {
                    continue;  // a pair, as long as they meet
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

    bool hasChanged(const ProxyPair& pair) const {
        return changed_.contains(pair.first) || changed_.contains(pair.second) ||
               ways_.contains(pair.first) || ways_.contains(pair.second);
    }

    Filter filter_;
    std::set<ProxyPair> set_;
    std::vector<ProxyPair> asked_;

    std::map<ProxyId, Way> ways_;  // of what sweeps
    std::map<ProxyId, ProxyGroups> groups_;
    std::set<ProxyPair> before_;    // the set before the last update
    std::set<ProxyPair> askedNow_;  // by findPairsNow() since the last update

    // As of the last update, or since.
    std::set<ProxyPair> met_;
    std::set<ProxyPair> refused_;
    std::set<ProxyPair> decided_;
    std::set<ProxyId> changed_;
};

/// The pairs of the boxes, in one update of a grid of the configuration, are those of brute force, and
/// all accounts agree. Returns how many there are.
template <class Scalar>
std::size_t expectPairsOfBruteForce(std::span<const Aabb<Scalar>> boxes,
                                    const GridConfig& config = {}) {
    PairWorld<Scalar> world(config);
    std::vector<Placed<Scalar>> proxies;
    for (const Aabb<Scalar>& box : boxes) {
        proxies.push_back({world.add(box), box});
    }
    world.update();
    world.checkThoroughly(proxies);
    return world.pairs.count();
}

}  // namespace hashphase::test
