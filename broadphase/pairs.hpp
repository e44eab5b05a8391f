// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, reported as the changes from one update to the next.
//
//     Pairs<float> pairs(grid);
//     const PairChanges changes = pairs.update();
//     for (const ProxyPair& pair : changes.born) { ... }
//
// A pair   Two proxies whose boxes overlap (or touch along a path, if a proxy sweeps), whose groups allow it, which
//          are not ignored, and which the filter accepts. Without the last two conditions, they are a candidate.
// A frame  Move proxies in the grid, then call Pairs::update(), which also updates the grid.
// Threads  No other thread may use the grid or this object during a call.
// Failure  Calls pass on exceptions of the filter and std::bad_alloc. If update() throws, the next update() reports
//          all changes since the last update() that returned. Any other call that throws changes nothing.
// Memory   grows with proxies and pairs. Pairs remembers refused candidates, up to 32 per proxy plus four per pair.
//          Beyond this, it remembers the pairs instead, and update() tests all overlaps of changed proxies.
// Late     You may create Pairs for a grid with proxies, and replace Pairs between two updates.
// Misuse   Asserted: a grid has at most one Pairs, and the filter calls no non-const member.

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
    /// Keeps references to the grid, which must outlive this object, and to `sweeps` until setSweeps(). The first
    /// update() reports all pairs. Asserted: `sweeps` belong to this grid, which has no other Pairs.
    /// Cost: O(proxies); all resting proxies wake.
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// Uses `sweeps` from now on; nullptr means none. Call it before you destroy the old sweeps. The next
    /// update() reports the changes. Asserted: `sweeps` belong to this grid; not within a query. Cost: O(sweeping
    /// proxies of the old and new sweeps).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid, and returns the pairs that began or ended since the last update. Each change
    /// appears once. The result does not depend on `parallelFor`. The filter runs on the caller's thread.
    /// Asserted: not within a query.
    /// Cost: grows with the changed proxies, and with the pairs of recently changed proxies. More than 256 proxies in
    /// a cell (or hash bucket) are sorted along its best axis. At worst (inverted boxes, or boxes that overlap most
    /// others on each axis but touch few), every pair of them takes a few tests. Paths of sweeping proxies are
    /// searched in parts or as rays, and against each other in up to 64 time slices.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Finds the proxy's pairs that began to overlap since the last update. Returns them as born; update() does not
    /// repeat them. Sweeping proxies count only at the start of their paths. May also return died pairs, if such a
    /// call returned them as born and a proxy was removed later. Asserted: the proxy is alive. Cost: as a box query.
    PairChanges findPairsNow(ProxyId id, PairFilter filter) &;

    /// findPairsNow() only with proxies in `others`, which must contain no duplicates. Skips ids in `others` that are
    /// not alive. Cost: O(others).
    PairChanges findPairsNow(ProxyId id, std::span<const ProxyId> others, PairFilter filter) &;

    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id, PairFilter filter) & {
        return findPairsNow(id, filter);
    }
    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id,
                                                          std::span<const ProxyId> others,
                                                          PairFilter filter) & {
        return findPairsNow(id, others, filter);
    }

    /// Asks the filter again about every proxy that overlaps this proxy, or met it along a path at the last update.
    /// Returns born and died pairs, also of removed proxies as in findPairsNow(). Asserted: the proxy is alive.
    /// Cost: as a few box queries; after many changes, the first call also files the boxes of the last update.
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// refilter() for many proxies in one pass. Asks once about each candidate, in ascending order. `ids` may contain
    /// duplicates. Cost: as refilter() for each proxy; at most finding all pairs from scratch, plus a box query per
    /// changed proxy.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// Asks the filter again about `pairs` only. Skips elements that are not a pair. Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// refilter() for all proxies. Call it when the filter itself has changed. Cost: finding all pairs from scratch,
    /// plus a box query per proxy changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// Excludes the pair, without asking the filter, until stopIgnoring() or until either proxy is removed. An
    /// existing pair ends at once, and is returned as died, perhaps with others as in findPairsNow(). The ids may be
    /// in any order. Asserted: the two proxies differ and are alive. Cost: O(1) amortised.
    PairChanges ignore(const ProxyPair& pair) &;
    /// ignore() for many pairs. Skips pairs with a proxy that is not alive. Cost: O(pairs) amortised.
    PairChanges ignore(std::span<const ProxyPair> pairs) &;

    /// Ends ignore(). If the two proxies overlap, or met along a path at the last update, and their groups allow it,
    /// asks the filter at once. Returns an accepted pair as born, and perhaps died pairs as in findPairsNow(). Skips
    /// pairs that are not ignored. Cost: O(1) per pair.
    PairChanges stopIgnoring(const ProxyPair& pair, PairFilter filter) &;
    PairChanges stopIgnoring(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// True when both proxies, in any order, are alive and the pair is ignored. Cost: O(1).
    [[nodiscard]] bool isIgnored(const ProxyPair& pair) const noexcept;

    /// False means that no pair is ignored. Cost: O(1).
    [[nodiscard]] bool mayIgnore() const noexcept;

    /// Appends all ignored pairs to `pairs`, sorted. Cost: O(n log n) for n pairs.
    void collectIgnored(std::vector<ProxyPair>& pairs) const;

    /// Calls Grid::clear(), and forgets all pairs, ignored pairs and sweeps. Reports no died pairs. Asserted: not
    /// within a query or the filter. Cost: O(Grid::indexLimit()).
    void clear();

    /// Appends all pairs as of the last update to `pairs`, sorted. Asserted: the grid has not changed since.
    /// Cost: finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// True when both are a pair, as of the last update and later calls. False if either proxy is not alive.
    /// Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// True only if nothing has changed since the last update: update() would find nothing. Always false
    /// while a proxy sweeps. Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept;

    /// Number of pairs.
    [[nodiscard]] std::size_t count() const noexcept { return state_.known.count; }

    /// Number of remembered refused candidates; 0 while remembersPairs(). Includes ignored candidates, but not pairs
    /// that groups refuse.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return state_.known.refusedCount(); }

    /// True while Pairs remembers pairs instead of refused candidates (see Memory): up to 256 updates longer than
    /// needed.
    [[nodiscard]] bool remembersPairs() const noexcept { return state_.known.arePairs(); }

    /// Returns what the last update() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return state_.cost; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused capacity for candidates, and scratch memory that later calls allocate again. Frees no memory of
    /// the grid. Invalidates returned lists. update() does this itself after 256 updates in a row with capacity for
    /// over eight times the candidates. Asserted: not within the filter. Cost: a copy of the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant as a sentence; empty if all of pairs/check.inl hold. Call it after update().
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    [[nodiscard]] Grid<Scalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] Sweeps<Scalar>* sweeps() const noexcept { return sweeps_; }
    /// Internal state. It may change with any version.
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
