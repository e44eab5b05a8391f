// SPDX-License-Identifier: Zlib
#pragma once

// Which overlapping proxies make a pair, and what an update reports of pairs.
//
//     const auto areEnemies = [&](ProxyId a, ProxyId b) { return team[a.index] != team[b.index]; };
//     for (const ProxyPair& pair : pairs.update(areEnemies).born) { ... }
//
// If groups and masks suffice, Grid::setGroups() costs less than a filter.

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

/// Decides which overlapping proxies make a pair: a function that is asked about two proxies, or about many pairs at
/// once.
///
/// Asked    once when two proxies begin to overlap; again about a refused pair when one of the two has changed; again
///          by refilter(). Never about ignored pairs, or pairs that groups refuse.
/// Order    ascending by ids. Thousands of candidates may come in parts, each part in that order.
/// Threads  the thread that calls Pairs
/// Misuse   Asserted: the filter does not change the grid; it may query it.
///
/// For parameters only, as FunctionRef: it refers to its function, without a copy.
class PairFilter {
public:
    /// Returns whether the two make a pair. The first id has the lower index.
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    /// Sets accepted[i], 0 before, to 1 if asked[i] make a pair. Both spans have the same length.
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): no PairFilter converts to OfOne
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]]) noexcept : ask_(ask, kAskEach) {}

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]])  // NOLINT: conversion is its purpose
        : ask_(ask) {}

    /// Asks about all pairs, and writes the answers to `accepted`, which has the same length and holds zeros.
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

/// The pairs that began and ended, each list sorted. Lists of update() are valid until the next update(), lists of
/// other calls until the next such call or update().
struct PairChanges {
    std::span<const ProxyPair> born;  ///< new pairs
    std::span<const ProxyPair> died;  ///< ended pairs; may name removed proxies
};

/// What an update cost.
struct PairCost {
    std::uint64_t boxesTested = 0;  ///< in all searches for candidates
    /// Candidates with a mobile proxy, tested whether they still overlap.
    std::uint64_t pairsWatched = 0;
    UpdateCost grid;  ///< what the update of the grid cost
};

}  // namespace hashphase
