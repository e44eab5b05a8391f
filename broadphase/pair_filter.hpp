// SPDX-License-Identifier: Zlib
#pragma once

// Which overlapping proxies make a pair, and what an update tells of pairs.

#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/proxy_id.hpp>
#include <broadphase/update_cost.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace hashphase {

/// Says which overlapping proxies make a pair: a function that is asked about two of them, or one
/// that is asked about many at once and sets accepted[i], given as 0, to 1 where asked[i] make a
/// pair. Asked once when two proxies begin to overlap, in ascending order of ids; again, for candidates
/// that it refused, whenever one of them has changed or refilter() is called; not about two that may not
/// pair by their groups. Thousands at once may be asked about in parts, each in that order. May ask the
/// grid, and must not change it (asserted). For parameters only, as FunctionRef.
class PairFilter {
public:
    using OfOne = FunctionRef<bool(ProxyId, ProxyId)>;
    using OfMany = FunctionRef<void(std::span<const ProxyPair> asked, std::span<char> accepted)>;

    template <std::convertible_to<OfOne> Ask>
    PairFilter(Ask&& ask HASHPHASE_LIFETIME_BOUND) noexcept  // NOLINT: conversion is its purpose
        : ask_(OfOne(ask)) {}

    template <class Ask>
        requires(!std::is_same_v<std::remove_cvref_t<Ask>, PairFilter> &&
                 !std::convertible_to<Ask, OfOne> && std::convertible_to<Ask, OfMany>)
    PairFilter(Ask&& ask HASHPHASE_LIFETIME_BOUND)  // NOLINT: conversion is its purpose
        : ask_(OfMany(ask)) {}

    void operator()(std::span<const ProxyPair> asked, std::span<char> accepted) const {
        if (const auto* ofMany = std::get_if<OfMany>(&ask_)) {
            (*ofMany)(asked, accepted);
            return;
        }
        const auto& ofOne = std::get<OfOne>(ask_);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            accepted[i] = ofOne(asked[i].first, asked[i].second) ? 1 : 0;
        }
    }

private:
    std::variant<OfOne, OfMany> ask_;
};

/// The filter that refuses nothing.
[[nodiscard]] inline bool acceptAllPairs(ProxyId /*first*/, ProxyId /*second*/) noexcept {
    return true;
}

/// Sorted; what update() returns is valid until the next update(), the rest until the next call of
/// another kind. A pair that died may name a proxy that was removed.
struct PairChanges {
    std::span<const ProxyPair> born;
    std::span<const ProxyPair> died;
};

/// What an update cost.
struct PairCost {
    std::uint64_t boxesTested = 0;
    /// Tested whether they still overlap: one of the two is mobile.
    std::uint64_t pairsWatched = 0;
    UpdateCost grid;
};

}  // namespace hashphase
