// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, reported as the changes from one update to the next.
//
//     Pairs<float> pairs(grid);
//     const PairChanges changes = pairs.update();
//     for (const ProxyPair& pair : changes.born) { ... }
//
// A pair   Two proxies whose boxes overlap (or touch on their ways, if one sweeps), whose groups allow it, which are
//          not ignored, and which the filter accepts. Before the filter answers, they are a candidate.
// A frame  Move proxies in the grid, then call update() here; it also updates the grid.
// Threads  Every member needs the grid and this object for itself.
// Failure  Exceptions of the filter and std::bad_alloc are passed on. If update() throws, the next one reports all
//          changes since the last that returned. Any other call that throws changes nothing.
// Memory   grows with proxies and pairs. Refused candidates are remembered, up to 32 per proxy plus four per pair.
//          Beyond, the pairs are remembered instead, and update() costs all overlaps of changed proxies.
// Late     Pairs may be created for a grid with proxies, and replaced between two updates.
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
    /// Keeps a reference to the grid, which must outlive this object, and to `sweeps` until setSweeps(). The first
    /// update() reports all pairs. Asserted: the sweeps are of the same grid, which has no other Pairs.
    /// Cost: O(proxies); all resting proxies wake.
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// Follows other sweeps from now on, or none (nullptr). Call it before the old sweeps are destroyed. The next
    /// update() reports the changes. Asserted: the sweeps are of the same grid; not within a query. Cost: O(proxies
    /// that sweep, before and after).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid, and returns the pairs born and died since the last update, each once. The
    /// result does not depend on `parallelFor`; the filter runs on the caller's thread. Asserted: not within a query.
    /// Cost: grows with the changed proxies, and with the pairs of those changed lately. More than 256 proxies in a
    /// cell (or hash bucket) are sorted and swept along its best axis; at worst (inverted boxes, or boxes side by
    /// side on every axis) a few tests of every two. Sweeping proxies are searched in parts of their ways or as rays,
    /// and against each other in up to 64 time slices.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Finds the proxy's pairs that began to overlap since the last update. Returns the births; update() does not
    /// repeat them. Finds sweeping proxies where their ways begin. May also return deaths: of pairs found by such
    /// calls, whose proxies were removed since. Asserted: the proxy is alive. Cost: as a box query.
    PairChanges findPairsNow(ProxyId id, PairFilter filter) &;

    /// findPairsNow() among `others` only, each named once. Skips others that are not alive. Cost: O(others).
    PairChanges findPairsNow(ProxyId id, std::span<const ProxyId> others, PairFilter filter) &;

    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id, PairFilter filter) & {
        return findPairsNow(id, filter);
    }
    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id,
                                                          std::span<const ProxyId> others,
                                                          PairFilter filter) & {
        return findPairsNow(id, others, filter);
    }

    /// Asks the filter again about every proxy that this one overlaps, or met on its way at the last update. Returns
    /// births and deaths, also of removed proxies as in findPairsNow(). Asserted: the proxy is alive. Cost: as a few
    /// box queries; after many changes, the first call also files the boxes of the last update.
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// refilter() for many proxies in one pass: asks once about each candidate, in ascending order. A proxy may be
    /// named more than once. Cost: as refilter() for each proxy; at most finding all pairs from scratch, and a box
    /// query per changed proxy.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// refilter() for these pairs only. Skips any that is not a pair. Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// refilter() for all proxies, when the filter itself has changed. Cost: finding all pairs from scratch, and a
    /// box query per proxy changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// Excludes the pair, without asking the filter, until stopIgnoring() or until one of the two is removed. An
    /// existing pair ends at once: returns its death, and perhaps others as in findPairsNow(). The ids may be in any
    /// order. Asserted: they name two proxies alive. Cost: O(1) amortised.
    PairChanges ignore(const ProxyPair& pair) &;
    /// ignore() for many pairs. Skips pairs with a proxy that is not alive. Cost: O(pairs) amortised.
    PairChanges ignore(std::span<const ProxyPair> pairs) &;

    /// Ends ignore(). If the two overlap, or met on their ways at the last update, and their groups allow it, asks
    /// the filter at once. Returns the birth. Skips pairs that are not ignored. Cost: O(1), for many O(pairs).
    PairChanges stopIgnoring(const ProxyPair& pair, PairFilter filter) &;
    PairChanges stopIgnoring(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// True when the two, in any order, are alive and ignored. Cost: O(1).
    [[nodiscard]] bool isIgnored(const ProxyPair& pair) const noexcept;

    /// False when no pair is ignored. Cost: O(1).
    [[nodiscard]] bool mayIgnore() const noexcept;

    /// Appends all ignored pairs to `pairs`, sorted. Cost: sorting them.
    void collectIgnored(std::vector<ProxyPair>& pairs) const;

    /// Grid::clear() that also forgets all pairs, ignored pairs and sweeps. Reports no deaths. Asserted: not within a
    /// query or the filter. Cost: O(Grid::indexLimit()).
    void clear();

    /// Appends all pairs as of the last update to `pairs`, sorted. Asserted: the grid has not changed since.
    /// Cost: finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// True when the two are a pair, as of the last update and the calls since. False if one of them is not alive.
    /// Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// True only if update() would find nothing, because nothing has changed since. Always false while a proxy
    /// sweeps. Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept;

    /// Number of pairs.
    [[nodiscard]] std::size_t count() const noexcept { return state_.known.count; }

    /// Number of refused candidates that are remembered; 0 while remembersPairs(). Ignored ones count, but not those
    /// that groups refuse.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return state_.known.refusedCount(); }

    /// True while pairs are remembered instead of refused candidates (see Memory), and up to 256 updates longer.
    [[nodiscard]] bool remembersPairs() const noexcept { return state_.known.arePairs(); }

    /// Returns what the last update() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return state_.cost; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees surplus room for candidates, and scratch that later calls allocate again; not the grid's. Invalidates
    /// returned lists. update() does this itself after 256 updates in a row with room for over eight times the
    /// candidates. Asserted: not within the filter. Cost: moving the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant as a sentence; empty when all of pairs/check.inl hold. Ask after update().
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    [[nodiscard]] Grid<Scalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] Sweeps<Scalar>* sweeps() const noexcept { return sweeps_; }
    /// The parts of the pairs. They may change with any version.
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
