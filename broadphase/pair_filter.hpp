// SPDX-License-Identifier: Zlib
#pragma once

// Which overlapping proxies make a pair, and what an update tells of pairs.
//
//     const auto areEnemies = [&](ProxyId a, ProxyId b) { return team[a.index] != team[b.index]; };
//     for (const ProxyPair& pair : pairs.update(areEnemies).born) { ... }
//
// Where groups and masks suffice, Grid::setGroups() costs less than a filter.

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

/// Says which overlapping proxies make a pair. Made of a function that is asked about two proxies and returns
/// whether they make a pair, or of one that is asked about many pairs at once.
///
/// Asked     once when two proxies begin to overlap; again about a refused candidate when one of the two has
///           changed; again about any candidate by refilter(). Never about two that may not pair by their
///           groups, or that are ignored.
/// Order     ascending by ids. Thousands of candidates may come in parts, each part in that order.
/// Threads   the thread that calls Pairs
/// Misuse    The filter may ask the grid but must not change it (asserted).
///
/// For parameters only, as FunctionRef: it refers to what it is given, be that a FunctionRef or another one.
class PairFilter {
public:
    /// Gets two ids, the one with the lower index first.
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    /// Sets accepted[i], given as 0, to 1 where asked[i] make a pair. Both spans have the same length.
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): no PairFilter converts to OfOne
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]]) noexcept : ask_(ask, kAskEach) {}

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask [[HASHPHASE_LIFETIME_BOUND]])  // NOLINT: conversion is its purpose
        : ask_(ask) {}

    /// Asks about all pairs, in one call or one by one, and writes the answers to `accepted`, which is as
    /// long and holds zeros.
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

/// The filter that refuses nothing.
[[nodiscard]] inline bool acceptAllPairs(ProxyId /*first*/, ProxyId /*second*/) noexcept {
    return true;
}

/// The pairs that began and ended, each list sorted. Lists of update() are valid until the next update().
/// Lists of findPairsNow() and of the refilter calls are valid until the next of these calls or update().
struct PairChanges {
    std::span<const ProxyPair> born;  ///< pairs now that were none before
    std::span<const ProxyPair> died;  ///< pairs no more; may name a proxy that was removed
};

/// What an update cost.
struct PairCost {
    std::uint64_t boxesTested = 0;  ///< in all searches for candidates
    /// Candidates tested whether they still overlap: those of which one proxy is mobile.
    std::uint64_t pairsWatched = 0;
    UpdateCost grid;  ///< what the update of the grid cost
};

}  // namespace hashphase
