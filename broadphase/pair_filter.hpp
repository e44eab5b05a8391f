// SPDX-License-Identifier: Zlib
#pragma once

// Filters that decide which overlapping proxies make a pair. Also PairChanges and PairCost, the results of an update.
//
//     const auto areEnemies = [&](ProxyId a, ProxyId b) { return team[a.index] != team[b.index]; };
//     for (const ProxyPair& pair : pairs.update(areEnemies).born) { ... }
//
// If groups and masks are enough, Grid::setGroups() costs less than a filter.

#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>
#include <broadphase/update_cost.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace hashphase {

/// Decides which overlapping proxies make a pair: a function that takes two ids, or a function that takes many pairs.
///
/// Calls    Pairs asks once when two proxies begin to overlap. It asks again about a refused pair when either
///          proxy's box or groups change or either proxy sweeps, and in refilter(), which also asks again about
///          accepted pairs. It never asks about ignored pairs, or pairs that groups refuse.
/// Order    ascending by ids. Thousands of candidates may arrive in parts; in that case, each part is sorted.
/// Threads  The filter runs on the thread that calls Pairs.
/// Misuse   Asserted: the filter does not change the grid. It may query the grid.
///
/// Use PairFilter only for parameters, like FunctionRef: it refers to the function, and makes no copy.
class PairFilter {
public:
    /// Returns whether the two proxies make a pair. The first id has the lower index.
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    /// Sets accepted[i] to 1 if the proxies asked[i] make a pair. Before the call, accepted[i] is 0. Both spans have
    /// equal lengths.
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): a PairFilter is copied, as it does not convert to OfOne
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]]) noexcept : ask_(ask, kAskEach) {}

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]])  // NOLINT: conversion is its purpose
        : ask_(ask) {}

    /// Asks about all pairs, and writes the answers to `accepted`, which must have equal length and contain only
    /// zeros.
    void operator()(std::span<const ProxyPair> asked, std::span<char> accepted) const {
        ask_(asked, accepted);
    }

private:
    static constexpr auto kAskEach = [](auto& ask, std::span<const ProxyPair> asked,
                                        std::span<char> accepted) {
        for (std::size_t i = 0; i < asked.size(); ++i) {
            accepted[i] = ask(asked[i].first, asked[i].second) ? 1 : 0;
        }
    };

    OfMany ask_;
};

/// The filter that accepts every pair.
[[nodiscard]] inline bool acceptAllPairs(ProxyId /*first*/, ProxyId /*second*/) noexcept {
    return true;
}

/// The pairs that began and the pairs that ended. Each list is sorted. Lists of update() are valid until the next
/// update(). Lists of other functions are valid until the next call that returns PairChanges. Pairs::clear() and
/// Pairs::releaseUnusedMemory() invalidate all lists.
struct PairChanges {
    std::span<const ProxyPair> born;  ///< new pairs
    std::span<const ProxyPair> died;  ///< ended pairs, including pairs of removed proxies
};

/// The cost of an update.
struct PairCost {
    std::uint64_t boxesTested = 0;  ///< box tests in the search for new candidates
    /// Number of known candidates whose overlap the update tested again.
    std::uint64_t pairsWatched = 0;
    UpdateCost grid;  ///< the cost of updating the grid
};

}  // namespace hashphase
