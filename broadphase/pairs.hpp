// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, as the changes from one update to the next.
//
// A pair is two proxies whose closed boxes overlap, whose groups let them (Grid::setGroups()), and which
// the filter accepts; where one of them sweeps, which touch on their ways. update() tells which pairs
// were born and which died since the last one, each once, sorted; what persists is not touched. Mostly
// nothing is remembered of a pair but what boxes and ways tell: a pair is new when they touch now and did
// not at the last update.
//
// A frame   move proxies in the grid, then update() here (it updates the grid).
// Threads   every member needs the grid and this object for itself.
// Failure   An exception, of the filter or for want of memory, is passed on. After one from findPairsNow()
//           or refilter() nothing has happened; one from update() has ended nothing: the frame goes
//           on, and the next update() tells all that has changed since the last one that returned.
// Memory    follows proxies and pairs. Of what overlaps, that which the filter refused is remembered,
//           up to 32 candidates for each proxy and four for each pair; where it refuses more, the pairs
//           are, and the update follows all that what has changed overlaps.
// Late      created over a grid that has proxies already, they begin as if these were all new; they may
//           go, and others come, between two updates.
// Misuse    one Pairs per grid at a time; and no call from within the filter; asserted.

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
class Sweeps;

/// Tells which pairs were born and which died from one update to the next.
template <class Scalar>
class HASHPHASE_BROADPHASE_EXPORT Pairs {
public:
    /// Keeps a reference to the grid, which must outlive this object, and to the sweeps over it if there
    /// are any, until others are given. They are of the same grid, which has no other Pairs (asserted).
    /// The first update() tells all pairs as born. Cost: O(proxies), and all that rested wakes.
    explicit Pairs(Grid<Scalar>& grid, Sweeps<Scalar>* sweeps = nullptr);
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// From now on follows these sweeps in place of those given before, or with nullptr none: pairs stay,
    /// and the next update() tells what that changes. They are of the same grid, and this is not called
    /// within a query (both asserted). Sweeps that are to end are taken out first. Cost: O(proxies that
    /// swept, and that do now).
    void setSweeps(Sweeps<Scalar>* sweeps);

    /// Ends the frame: updates the grid and returns all pairs born and died since the last call.
    /// The result does not depend on `parallelFor`; the filter is asked on the caller's thread.
    /// Cost: follows what changed, and the pairs of what changed lately. Where more than 256 share a
    /// cell, or by accident or malice a bucket of the hash, it is that of sweeping them along one
    /// axis, the best one of each; at worst, for proxies that lie side by side along every axis and do
    /// not touch, or that are inverted, a few tests of every two. Ways of Sweeps are searched in up to
    /// 40 parts each, and against each other in up to 64.
    PairChanges update(PairFilter filter = acceptAllPairs, ParallelFor parallelFor = serialFor) &;

    /// Pairs of one proxy, which is alive (asserted), that have come to overlap since the last update,
    /// at once; update() will not report them again. Returns these births; of what sweeps, itself or
    /// another one, not what it meets on its way, but what it touches where that begins. Deaths, now and
    /// then, of pairs found at once of which a proxy was removed since: they do not gather where no
    /// update() follows. update() reports the rest of them.
    /// Cost: that of a box query.
    PairChanges findPairsNow(ProxyId id, PairFilter filter) &;

    /// The same of its pairs with others alone, each named once; those that are not alive are passed
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

    /// Asks the filter again about everything that the proxy, which is alive (asserted), overlaps, or
    /// met on its way at the last update, refused or not, at once; and deaths as findPairsNow() does. Cost:
    /// that of a few box queries. Where many proxies have changed since the last update, the first call
    /// after it files their boxes of that update once for all calls up to the next one.
    PairChanges refilter(ProxyId id, PairFilter filter) &;

    /// The same for many proxies, in one pass: the filter is asked once about each candidate, in ascending
    /// order. A proxy may be named more than once. Cost: as refilter() for each proxy; at most that of
    /// finding all pairs from scratch, and a box query for each proxy that has changed.
    PairChanges refilter(std::span<const ProxyId> ids, PairFilter filter) &;

    /// The same about these pairs alone; what is none is passed over. Cost: O(pairs).
    PairChanges refilter(std::span<const ProxyPair> pairs, PairFilter filter) &;

    /// The same for all proxies: the filter has changed. Cost: that of finding all pairs from scratch,
    /// and a box query for each proxy that has changed since the last update.
    PairChanges refilterAll(PairFilter filter) &;

    /// Grid::clear(), and all that is known of pairs and of sweeps with it: as new ones, over a new grid.
    /// No deaths are reported. Cost: O(Grid::indexLimit()).
    void clear();

    /// The whole set as of the last update, sorted, appended to `pairs`. The grid must not have
    /// changed since (asserted). Cost: that of finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// Whether the two are a pair, as of the last update, or as was told since. Not of one that is not
    /// alive. Cost: O(1).
    [[nodiscard]] bool isPair(const ProxyPair& pair) const noexcept;

    /// Number of pairs in the set.
    [[nodiscard]] std::size_t count() const noexcept { return state_.known.count; }

    /// Number of overlapping candidates that the filter refused, as they are remembered: none while the pairs
    /// are, instead. Those that may not pair by their groups are not counted.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return state_.known.refusedCount(); }

    /// Whether so many overlap, of which the filter refuses most, that the pairs are remembered in their
    /// place; up to 256 updates longer.
    [[nodiscard]] bool remembersPairs() const noexcept { return state_.known.arePairs(); }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return state_.cost; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back what is not used, but nothing of the grid's, which has a call of its own: room for more
    /// candidates than there are, and what only the next call would use, which takes it again. What calls
    /// have returned is not valid any more. update() does it by itself when there has been room for more
    /// than eight times as many in 256 updates in a row. Not within the filter (asserted). Cost: moving
    /// what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after update()):
    /// - The watched candidates are the overlapping ones that may pair and of which one is mobile, each once.
    /// - count() is the number of overlapping and swept candidates that may pair, less the refused ones, and
    ///   of the pairs that are kept.
    /// - Of each swept candidate one sweeps.
    /// - The pairs that are kept overlap and may not pair.
    /// While the pairs are remembered, that count() is their number, and each overlaps or is swept; not that
    /// none is missing.
    [[nodiscard]] std::string validate() const;

private:
    Grid<Scalar>& grid_;
    Sweeps<Scalar>* sweeps_;
    detail::PairState<Scalar> state_;
};

extern template class Pairs<float>;
extern template class Pairs<double>;

}  // namespace hashphase
