// SPDX-License-Identifier: Zlib
#pragma once

// Names for what is in a grid: a proxy stands for an object of the caller's by its box.

#include <broadphase/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hashphase {

/// A value that names one proxy of one grid. Zero is null. `index` is small and dense (below the
/// largest number of proxies that were ever alive at once, those removed since the last update
/// included that it had seen), so callers keep their own data in an array by it; `generation` tells a
/// proxy from earlier ones with the same index.
struct ProxyId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    /// True for ProxyId{}, which names nobody; not for one whose proxy was removed: Grid::contains().
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ProxyId&, const ProxyId&) = default;
};

/// Two overlapping proxies, first.index < second.index.
struct ProxyPair {
    ProxyId first;
    ProxyId second;

    friend constexpr auto operator<=>(const ProxyPair&, const ProxyPair&) = default;
};

/// How a proxy is expected to behave. A hint that saves work and never changes a result: a resting
/// proxy may move, a mobile one that stays unchanged comes to rest by itself.
enum class Mobility : std::uint8_t { mobile, resting };

namespace detail {

/// A hash of what has an index and a generation; differs where these do.
template <class Id>
struct IdHash {
    [[nodiscard]] std::size_t operator()(const Id& id) const noexcept {
        return std::hash<std::uint64_t>{}(std::uint64_t{id.generation} << 32 | id.index);
    }
};

}  // namespace detail
}  // namespace hashphase

/// For keys of std::unordered_map. What is kept of every proxy is better kept in an array by its index.
template <>
struct std::hash<hashphase::ProxyId> : hashphase::detail::IdHash<hashphase::ProxyId> {};
