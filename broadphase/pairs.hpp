// SPDX-License-Identifier: Zlib
#pragma once

// The exact set of overlapping pairs of a grid, as the changes from one update to the next.
//
// A pair is two proxies whose closed boxes overlap and which the filter accepts. update() tells
// which pairs were born and which died since the last one, each once, sorted; what persists is not
// touched. Nothing is remembered of a pair but what the boxes tell: a pair is new when the boxes
// overlap now and did not at the last update.
//
// A frame   move proxies in the grid, then update() here (it updates the grid).
// Threads   every member needs the grid and this object for itself.
// Misuse    one Pairs per grid, created before the grid's first proxy; asserted.

#include <broadphase/detail/flat_set.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/grid.hpp>

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace hashphase {

/// Says which overlapping proxies make a pair: a function that is asked about two of them, or one
/// that is asked about many at once and sets accepted[i], given as 0, to 1 where asked[i] make a
/// pair. Asked once when two proxies begin to overlap, in ascending order of ids; again, for couples
/// that it refused, whenever one of them has changed or refilter() is called. Must not change the
/// grid. For parameters only, as FunctionRef.
class PairFilter {
public:
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    PairFilter(Ask&& ask) noexcept : ask_(OfOne(ask)) {}  // NOLINT: conversion is its purpose

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask)  // NOLINT: conversion is its purpose
        : ask_(OfMany(ask)) {}

    void operator()(std::span<const ProxyPair> asked, std::span<char> accepted) const {
        if (const OfMany* ofMany = std::get_if<OfMany>(&ask_)) {
            (*ofMany)(asked, accepted);
            return;
        }
        const OfOne& ofOne = std::get<OfOne>(ask_);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            accepted[i] = ofOne(asked[i].first, asked[i].second) ? 1 : 0;
        }
    }

private:
    std::variant<OfOne, OfMany> ask_;
};

/// Sorted; valid until the next call. A pair that died may name a proxy that was removed.
struct PairChanges {
    std::span<const ProxyPair> born;
    std::span<const ProxyPair> died;
};

/// What an update cost.
struct PairCost {
    std::uint64_t boxesTested = 0;
    std::uint64_t couplesWatched = 0;  ///< of which one box changed lately
    UpdateCost grid;
};

template <class Scalar>
class Pairs {
public:
    /// Keeps a reference to the grid, which must outlive this object.
    explicit Pairs(Grid<Scalar>& grid);
    ~Pairs();

    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;

    /// Ends the frame: updates the grid and returns all pairs born and died since the last call.
    /// Cost: follows what changed, and the pairs of what changed lately.
    PairChanges update(PairFilter filter);

    /// Pairs of one proxy that have come to overlap since the last update, at once; update() will
    /// not report them again. Returns births only. Cost: that of a box query.
    PairChanges announce(ProxyId id, PairFilter filter);

    /// Asks the filter again about everything that the proxy overlaps, refused or not, at once.
    /// Cost: that of a box query, and a look at all watched couples.
    PairChanges refilter(ProxyId id, PairFilter filter);

    /// The whole set as of the last update, sorted, appended to `pairs`. The grid must not have
    /// changed since (asserted). Cost: that of finding all pairs from scratch.
    void collect(std::vector<ProxyPair>& pairs) const;

    /// Number of pairs in the set.
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

    /// Number of overlapping couples that the filter refused.
    [[nodiscard]] std::size_t refusedCount() const noexcept { return refusedCount_; }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return cost_; }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold (ask after update()):
    /// - The watched couples are sorted, each once.
    /// - The watched couples are exactly the overlapping ones of which one changed lately.
    /// - count() is the number of overlapping couples less the refused ones.
    [[nodiscard]] std::string validate() const;

private:
    /// Two slots and whether the filter refused them: first << 33 | second << 1 | refused, so that
    /// couples sort by slots.
    using Couple = std::uint64_t;

    static constexpr Couple couple(std::uint32_t a, std::uint32_t b, bool refused) noexcept {
        const Couple low = a < b ? a : b;
        const Couple high = a < b ? b : a;
        return low << 33 | high << 1 | (refused ? 1U : 0U);
    }
    static constexpr std::uint32_t first(Couple c) noexcept {
        return static_cast<std::uint32_t>(c >> 33);
    }
    static constexpr std::uint32_t second(Couple c) noexcept {
        return static_cast<std::uint32_t>(c >> 1) & 0x7fffffffU;
    }
    static constexpr bool isRefused(Couple c) noexcept { return (c & 1) != 0; }

    [[nodiscard]] ProxyPair pairOf(Couple c) const noexcept {
        return {grid_.idOf(first(c)), grid_.idOf(second(c))};
    }
    [[nodiscard]] bool isWatched(std::uint32_t changedAt, std::uint32_t update) const noexcept;
    [[nodiscard]] bool changedLately(Couple c, std::uint32_t update) const noexcept;

    void captureWoken();
    void findNew();
    void joinMobile(QueryCost& cost);
    void walkAroundChanged(bool amongMobile, QueryCost& cost);
    void mergeWatched(PairFilter filter);
    void keepOrDrop(Couple c);
    void addUndecided(Couple& c);
    void announceFresh();
    void decide(PairFilter filter);
    void publish();
    void beginCall();
    void bear(Couple c);
    void bury(Couple c);
    [[nodiscard]] bool isToAskAgain(Couple c) const;
    void findUnknown(std::uint32_t slot);
    void forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const;

    Grid<Scalar>& grid_;
    std::vector<Aabb<Scalar>> before_;  // each slot's box at the last update; NaN when it had none

    std::vector<Couple> watched_;      // overlapping couples of which one changed lately, sorted
    std::vector<Couple> captured_;     // to be merged into watched_ at the next update
    std::size_t capturedChanges_ = 0;  // of the grid's changes, how many captureWoken() has seen
    detail::FlatSet announced_;        // which of captured_ were decided since the last update
    detail::FlatSet refusedAtRest_;    // couples refused and no longer watched

    std::vector<Aabb<Scalar>> beforeByEntry_;  // before_ in the order of the grid's mobile table
    std::vector<Couple> fresh_;
    std::vector<Couple> merged_;
    std::vector<Couple*> undecided_;  // ascending: what the filter is to be asked about
    std::vector<ProxyPair> asked_;
    std::vector<char> accepted_;
    std::vector<std::uint32_t> woken_;
    detail::Table<Scalar> wokenTable_;
    std::vector<ProxyPair> born_;
    std::vector<ProxyPair> died_;
    std::size_t count_ = 0;
    std::size_t refusedCount_ = 0;
    PairCost cost_;
};

extern template class Pairs<float>;
extern template class Pairs<double>;

}  // namespace hashphase
