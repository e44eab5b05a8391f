// SPDX-License-Identifier: Zlib
#pragma once

// A grid and its pairs, watched: what the changes report is applied to a set of pairs, and every
// promise about the changes is checked on the way. Compiled once for all test programs.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/oracles.hpp>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
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
    void move(ProxyId id, const Aabb<Scalar>& box);
    void remove(ProxyId id);
    void setGroups(ProxyId id, const ProxyGroups& groups);
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
    void renewSweeps(bool areThere);
    [[nodiscard]] bool doesSweep(ProxyId id) const { return ways_.contains(id); }
    [[nodiscard]] MovingBox<Scalar> motion(const Placed<Scalar>& proxy) const {
        const auto way = ways_.find(proxy.id);
        return way == ways_.end() ? MovingBox<Scalar>{proxy.box}
                                  : MovingBox<Scalar>{way->second.box.value_or(proxy.box),
                                                      way->second.displacement};
    }

    /// Shifts the origin, and notes whose boxes that changes, as Grid::shiftOrigin() says.
    void shiftOrigin(const Vector3<Scalar>& shift);

    /// Gives the grid other pairs, for which everybody is new; before that it may have none for an update.
    void renewPairs(bool withUpdateBetween);

    /// Removes every proxy, and nothing is reported of any pair.
    void clear();

    void refilter(ProxyId id);
    void refilter(std::span<const ProxyId> ids);
    void refilterAll();
    void findPairsNow(ProxyId id);
    void ignore(const ProxyPair& pair);
    void stopIgnoring(const ProxyPair& pair);
    /// None is ignored any more, after calls on `pairs` itself.
    void forgetIgnored() { ignored_.clear(); }

    /// Ends the frame. What the filter was asked is in asked() afterwards.
    PairChanges update();

    /// To be called after update(): the pairs are those of brute force, and all accounts agree.
    void check(std::span<const Placed<Scalar>> proxies);

    /// Invariants, and that the filter was asked what it had to be and nothing else.
    void checkThoroughly(std::span<const Placed<Scalar>> proxies);

    [[nodiscard]] const std::set<ProxyPair>& set() const noexcept { return set_; }
    [[nodiscard]] const std::vector<ProxyPair>& asked() const noexcept { return asked_; }

    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps;
    Pairs<Scalar> pairs;
    Colours colours;

    /// What a call on `pairs` itself reports.
    void apply(const PairChanges& changes);

private:
    struct Way {
        std::optional<Aabb<Scalar>> box;  // none where it begins at the proxy's box
        Vector3<Scalar> displacement;
    };

    void forgetPairs();
    void noteWay(ProxyId id, const Way& way, Sweep mode);
    Filter recordingFilter();
    void noteAsked(const char* what);
    void noteRefiltered(const PairChanges& changes);
    void noteDecided();
    void expectIgnored() const;
    void checkAsked(std::span<const Placed<Scalar>> proxies);
    [[nodiscard]] ProxyGroups groupsOf(ProxyId id) const;
    [[nodiscard]] bool mayPair(const ProxyPair& pair) const;
    [[nodiscard]] bool mayBeAsked(const ProxyPair& pair) const;
    [[nodiscard]] bool doMeet(const Placed<Scalar>& a, const Placed<Scalar>& b) const;
    [[nodiscard]] bool hasChanged(const ProxyPair& pair) const;

    Filter filter_;
    std::set<ProxyPair> set_;
    std::vector<ProxyPair> asked_;

    std::map<ProxyId, Way> ways_;  // of what sweeps
    std::map<ProxyId, ProxyGroups> groups_;
    std::set<ProxyPair> ignored_;
    std::set<ProxyPair> before_;    // the set before the last update
    std::set<ProxyPair> askedNow_;  // by findPairsNow() since the last update

    // As of the last update, or since.
    std::set<ProxyPair> met_;
    std::set<ProxyPair> refused_;
    std::set<ProxyPair> decided_;
    std::set<ProxyId> changed_;
};

}  // namespace hashphase::test
