// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, reported as the changes from one update to the next.
//
//     Pairs<float> pairs(grid);
//     const PairChanges changes = pairs.update();
//     for (const ProxyPair& pair : changes.born) { ... }
//
// A pair   Two proxies are a pair if their boxes overlap (or touch along a path, if a proxy sweeps), their groups
//          allow it, they are not ignored, and the filter accepts them. If the first two conditions hold, they are a
//          candidate.
// A frame  Move proxies in the grid, then call Pairs::update(), which also updates the grid.
// Threads  No other thread may use the grid or this object during a call.
// Failure  Calls can throw std::bad_alloc, and exceptions of the filter. If update() throws, the next update()
//          reports all changes since the last update() that returned. Any other call that throws changes nothing.
// Memory   grows with proxies and pairs. Pairs normally remembers refused candidates: all other candidates are pairs.
//          Above a total of 32 refused candidates per proxy plus four per pair, it remembers the pairs instead. In
//          that case, update() searches again for all overlaps of changed proxies.
// Late     You may create Pairs for a grid that has proxies, and replace Pairs between two updates.
// Misuse   Asserted: a grid has at most one Pairs; the filter calls only const functions of the grid and Pairs.

#include <broadphase/export.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pair_filter.hpp>
#include <broadphase/pairs/pair_state.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hashphase {

template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Sweeps;

/// The pairs of a grid.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Pairs {
public:
    /// Keeps a reference to the grid, which must outlive this object. Uses `sweeps` until setSweeps() replaces them.
    /// The first update() reports all pairs as born. Wakes all resting proxies. Asserted: `sweeps` belong to this
    /// grid, which has no other Pairs. Cost: O(proxies).
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// Replaces the sweeps; nullptr means none. Call it before you destroy the old sweeps. The next update() reports
    /// the pairs that begin or end because of this. Asserted: `sweeps` belong to this grid; this thread runs no
    /// query. Cost: O(sweeping proxies of the old and new sweeps).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid, and returns the pairs that began or ended since the last update. Each change
    /// is returned once: update() omits changes that other calls have returned. The result does not depend on
    /// `parallelFor`. The filter runs on the caller's thread. Asserted: this thread runs no query.
    /// If over 256 proxies share a cell (or hash bucket), update() sorts them along one axis. To keep long paths
    /// cheap, update() searches the path of a sweeping proxy in parts or as a ray. For pairs of sweeping proxies, it
    /// cuts the frame into up to 64 time slices.
    /// Cost: grows with the changed proxies, and with the pairs of recently changed proxies. At worst, a few tests
    /// for each combination of two proxies in a cell. The worst cases are inverted boxes, and boxes that overlap most
    /// other boxes on each single axis, but touch few of them.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Finds pairs of this proxy that began to overlap since the last update. Returns them as born; update() does not
    /// repeat them. For sweeping proxies, only the boxes at the start of paths count: for Sweeps::set() with a
    /// MovingBox, MovingBox::box. May also return died pairs. Calls since the last update() returned these pairs as
    /// born, and afterwards a proxy of the pair was removed. Asserted: the proxy is alive. Cost: as a box query, plus
    /// a comparison for each sweeping proxy.
    PairChanges findPairsNow(ProxyId id, PairFilter filter) &;

    /// Like findPairsNow(id, filter), but finds only pairs with proxies in `others`, which must contain no
    /// duplicates. Skips ids that are not alive. Cost: O(others).
    PairChanges findPairsNow(ProxyId id, std::span<const ProxyId> others, PairFilter filter) &;

    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id, PairFilter filter) & {
        return findPairsNow(id, filter);
    }
    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id,
                                                          std::span<const ProxyId> others,
                                                          PairFilter filter) & {
        return findPairsNow(id, others, filter);
    }

    /// Asks the filter again about each proxy that overlaps this proxy now, or touched it along a path at the last
    /// update. Returns born and died pairs. Died pairs may include pairs of removed proxies: see findPairsNow().
    /// Asserted: the proxy is alive. Cost: as a few box queries. The first call after many changes costs at most as
    /// much as update().
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// refilter() for many proxies, in one pass. Asks about each candidate once, in ascending order. `ids` may
    /// contain duplicates. Cost: as refilter() for each proxy, but at most the cost of finding all pairs from scratch
    /// and making one box query per changed proxy.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// Asks the filter again about these pairs only. Skips elements that are not a pair, such as refused candidates.
    /// Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// refilter() for all proxies. Call it when the filter has changed. Cost: as finding all pairs from scratch, plus
    /// a box query per proxy that changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// Excludes the pair, without asking the filter, until stopIgnoring() or until either proxy is removed. If the
    /// pair exists, returns it as died. May also return other died pairs: see findPairsNow(). The ids may be in any
    /// order. Asserted: the two proxies differ and are alive. Cost: O(1) amortised.
    PairChanges ignore(const ProxyPair& pair) &;
    /// ignore() for each pair. Skips pairs with a proxy that is not alive. Cost: O(pairs) amortised.
    PairChanges ignore(std::span<const ProxyPair> pairs) &;

    /// Ends ignore(). If the groups allow the pair, and the two proxies overlap now or touched along a path at the
    /// last update, asks the filter immediately. Returns an accepted pair as born. May also return died pairs: see
    /// findPairsNow(). Skips pairs that are not ignored. Cost: O(1) per pair.
    PairChanges stopIgnoring(const ProxyPair& pair, PairFilter filter) &;
    PairChanges stopIgnoring(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// True when the pair is ignored and both proxies are alive. The ids may be in any order. Cost: O(1).
    [[nodiscard]] bool isIgnored(const ProxyPair& pair) const noexcept;

    /// True when at least one pair is ignored. Pairs of removed proxies may count too. Cost: O(1).
    [[nodiscard]] bool mayIgnore() const noexcept;

    /// Appends all ignored pairs, sorted, to `pairs`. Cost: O(n log n) for n ignored pairs.
    void collectIgnored(std::vector<ProxyPair>& pairs) const;

    /// Calls Grid::clear(), forgets all pairs and ignored pairs, and ends the sweep of every proxy. Keeps the Sweeps
    /// object. Reports no died pairs. Asserted: this thread runs no query or filter. Cost: O(Grid::indexLimit()).
    void clear();

    /// Appends all pairs that exist now, sorted, to `pairs`. Asserted: the grid has not changed since the last
    /// update(). Cost: as finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// True when the two proxies are a pair after the last call that returned PairChanges. Later moves do not count.
    /// False if either proxy is not alive. Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// True only if update() would find nothing, because nothing has changed since the last update. Always false
    /// while a proxy sweeps. Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept;

    /// Number of pairs.
    [[nodiscard]] std::size_t count() const noexcept { return state_.known.count; }

    /// Number of refused candidates that Pairs remembers; 0 if remembersPairs(). Includes ignored candidates, but not
    /// pairs that groups refuse.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return state_.known.refusedCount(); }

    /// True while Pairs remembers pairs instead of refused candidates (see Memory). After the refused candidates are
    /// few again, may stay true for up to 256 updates with changed proxies.
    [[nodiscard]] bool remembersPairs() const noexcept { return state_.known.arePairs(); }

    /// Returns what the last update() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return state_.cost; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused capacity for candidates, and scratch memory that later calls allocate again. Frees no memory of
    /// the grid. Invalidates returned lists. update() calls this function after 256 updates in a row with over eight
    /// times the needed capacity. Asserted: the filter is not running. Cost: a copy of the remaining data.
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about a broken invariant; empty if all invariants of pairs/check.inl hold. Call it after
    /// update().
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    [[nodiscard]] Grid<Scalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] Sweeps<Scalar>* sweeps() const noexcept { return sweeps_; }
    /// Internal data. It may change with any version.
    [[nodiscard]] detail::PairState<Scalar>& state() noexcept { return state_; }
    [[nodiscard]] const detail::PairState<Scalar>& state() const noexcept { return state_; }

private:
    Grid<Scalar>& grid_;
    Sweeps<Scalar>* sweeps_;
    detail::PairState<Scalar> state_;
};

extern template class Pairs<float>;
extern template class Pairs<double>;

}  // namespace hashphase
