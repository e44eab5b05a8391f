// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, as the changes from one update to the next.
//
// A pair is two proxies whose closed boxes overlap, or that touch on their ways where one of them sweeps;
// whose groups let them pair (Grid::setGroups()); which are not ignored (ignore()); and which the filter
// accepts. update() tells which pairs were born and which died since the last update, each once, sorted.
// Pairs that persist are not touched.
// Mostly a pair takes no memory: it is new when its boxes touch now and did not at the last update.
//
//     Pairs<float> pairs(grid);
//     const PairChanges changes = pairs.update();
//     for (const ProxyPair& pair : changes.born) { ... }
//
// A frame   move proxies in the grid, then update() here (it updates the grid).
// Threads   every member needs the grid and this object for itself.
// Failure   An exception of the filter, or std::bad_alloc, is passed on. If findPairsNow(), refilter(),
//           ignore() or stopIgnoring() throws, nothing has happened. If update() throws, the frame has not
//           ended: the next update() tells all that has changed since the last one that returned.
// Memory    follows proxies and pairs. Overlapping candidates that the filter refused are remembered, up to
//           32 for each proxy and four for each pair. Where it refuses more, the pairs are remembered
//           instead, and the cost of update() follows all that changed proxies overlap.
// Late      Pairs may be created over a grid that has proxies already: these count as new. Pairs may be
//           destroyed, and others created, between two updates.
// Misuse    Two Pairs of a grid at a time, and calls from within the filter, are asserted.

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

/// Tells which pairs were born and which died from one update to the next.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Pairs {
public:
    /// Keeps a reference to the grid, which must outlive this object, and to `sweeps`, if there are any,
    /// until setSweeps(). The sweeps are of the same grid, which has no other Pairs (asserted). The first
    /// update() tells all pairs as born. Cost: O(proxies), and all resting proxies wake.
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// Follows these sweeps from now on, in place of those before; with nullptr none. Pairs stay, and the
    /// next update() tells what changes. The sweeps are of the same grid, and this is not called within a
    /// query (both asserted). Call it before the old sweeps are destroyed. Cost: O(proxies that swept, and
    /// that sweep now).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid and returns all pairs born and died since the last call.
    /// The result does not depend on `parallelFor`; the filter is asked on the caller's thread.
    /// Cost: follows the proxies that changed, and the pairs of those that changed lately. Where more than
    /// 256 proxies share a cell, or by accident or malice a bucket of the hash, they are sorted and swept
    /// along the best axis of that cell; at worst, for proxies that lie side by side along every axis and do
    /// not touch, or that are inverted, a few tests of every two. Ways of Sweeps are searched in up to 40
    /// parts each, and against each other in up to 64.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Finds the pairs of one proxy, which is alive (asserted), that have come to overlap since the last
    /// update. Returns their births; update() will not report them again. Proxies that sweep are found where
    /// their ways begin, not on their ways.
    /// May also return deaths: of pairs found by such calls whose proxies were removed since. So they do not
    /// pile up where no update() follows; update() reports the others.
    /// Cost: that of a box query.
    PairChanges findPairsNow(ProxyId id, PairFilter filter) &;

    /// Finds the proxy's pairs with `others` only, each named once; others that are not alive are passed
    /// over. Cost: O(others).
    PairChanges findPairsNow(ProxyId id, std::span<const ProxyId> others, PairFilter filter) &;

    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id, PairFilter filter) & {
        return findPairsNow(id, filter);
    }
    [[deprecated("findPairsNow()")]] PairChanges announce(ProxyId id,
                                                          std::span<const ProxyId> others,
                                                          PairFilter filter) & {
        return findPairsNow(id, others, filter);
    }

    /// Asks the filter again about every proxy that this one, which is alive (asserted), overlaps, or met on
    /// its way at the last update, refused or not. Returns births and deaths, with deaths of removed proxies
    /// as findPairsNow(). Cost: that of a few box queries. Where many proxies have changed since the last
    /// update, the first call after it files their boxes of that update once for all calls up to the next
    /// update.
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// refilter() for many proxies, in one pass: asks the filter once about each candidate, in ascending
    /// order. A proxy may be named more than once. Cost: as refilter() for each proxy; at most that of
    /// finding all pairs from scratch, and a box query for each proxy that has changed.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// refilter() for these pairs only; two proxies that are no pair are passed over. Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// refilter() for all proxies, where the filter itself has changed. Cost: that of finding all pairs from
    /// scratch, and a box query for each proxy that has changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// From now on the two are no pair, whatever their groups and the filter say, and the filter is not asked
    /// about them, until stopIgnoring(). A present pair ends at once: returns its death, with deaths of removed
    /// proxies as findPairsNow(). When one of the two is removed, they are ignored no more. Two ids, both alive
    /// (asserted), in any order. Where it throws, nothing has happened. Cost: O(1) amortised.
    PairChanges ignore(const ProxyPair& pair) &;
    /// ignore() for many; those of which one is not alive are passed over. Cost: O(pairs) amortised.
    PairChanges ignore(std::span<const ProxyPair> pairs) &;

    /// Ends ignore(). Where the two overlap, or met on their ways at the last update, and may pair by their
    /// groups, the filter is asked at once: returns the birth. Two that are not ignored are passed over. Where
    /// it throws, nothing has happened. Cost: O(1), for many O(pairs).
    PairChanges stopIgnoring(const ProxyPair& pair, PairFilter filter) &;
    PairChanges stopIgnoring(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// Whether the two, in any order, are alive and ignored. Cost: O(1).
    [[nodiscard]] bool isIgnored(const ProxyPair& pair) const noexcept;

    /// Whether any two may be. Cost: O(1).
    [[nodiscard]] bool mayIgnore() const noexcept;

    /// Appends all pairs that are ignored, sorted, to `pairs`. Cost: that of sorting them.
    void collectIgnored(std::vector<ProxyPair>& pairs) const;

    /// Grid::clear(), which also forgets all pairs, those that are ignored, and sweeps: everything is as new,
    /// over a new grid. Reports no deaths. Not within a query or the filter (asserted). Cost:
    /// O(Grid::indexLimit()).
    void clear();

    /// Appends the whole set of pairs as of the last update, sorted, to `pairs`. The grid must not have
    /// changed since (asserted). Cost: that of finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// Whether the two are a pair, as of the last update and the calls since. False where one of the two is
    /// not alive. Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// Whether update() would find nothing: no proxy has changed since the last one, and no pair. Cost: O(1).
    [[nodiscard]] bool isUpToDate() const noexcept;

    /// Number of pairs in the set.
    [[nodiscard]] std::size_t count() const noexcept { return state_.known.count; }

    /// Number of refused candidates that are remembered, the ignored ones among them; 0 while
    /// remembersPairs(). Candidates that may not pair by their groups are not counted.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return state_.known.refusedCount(); }

    /// True while the pairs are remembered instead of the refused candidates, because the filter refuses most
    /// of very many candidates; and up to 256 updates longer.
    [[nodiscard]] bool remembersPairs() const noexcept { return state_.known.arePairs(); }

    /// What the last update() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return state_.cost; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back unused memory: room for more candidates than there are, and scratch, which the next call
    /// takes again. Lists that calls have returned are not valid any more. The grid has a call of its own.
    /// update() does it by itself when there has been room for more than eight times as many candidates in
    /// 256 updates in a row. Not within the filter (asserted). Cost: moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after update()):
    /// - The watched candidates are the overlapping ones that may pair and of which one is mobile, each once.
    /// - count() is the number of overlapping and swept candidates that may pair, less the refused ones, and
    ///   of the pairs that are kept.
    /// - Of each swept candidate one sweeps.
    /// - The pairs that are kept overlap and may not pair.
    /// - No pair that is ignored is a pair.
    /// While remembersPairs(), it says only the last, and whether count() is their number, and each overlaps
    /// or is swept.
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    [[nodiscard]] Grid<Scalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] Sweeps<Scalar>* sweeps() const noexcept { return sweeps_; }
    /// What the pairs are made of. It may change with any version.
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
