// SPDX-License-Identifier: Zlib
#pragma once

// Names for the proxies of a grid. A proxy stands for an object of the caller by its box.
//
//     const ProxyId id = grid.add(box);
//     objects.resize(grid.indexLimit());
//     objects[id.index] = &object;  // the caller's data, by index

#include <broadphase/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hashphase {

/// A value that names one proxy of one grid. Zero is null. Ids are ordered by index, then by generation.
struct ProxyId {
    /// Small and dense, so that callers keep their own data in an array by index. Below the largest number of
    /// proxies that were ever alive at once; proxies removed since the last update count, if that update saw
    /// them.
    std::uint32_t index = 0;
    /// Tells a proxy from earlier ones with the same index.
    std::uint32_t generation = 0;

    /// True for ProxyId{}, which names no proxy. An id whose proxy was removed is not null: ask
    /// Grid::contains().
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ProxyId&, const ProxyId&) = default;
};

/// Two proxies that make a pair, first.index < second.index. Ordered by first, then by second.
struct ProxyPair {
    ProxyId first;
    ProxyId second;

    friend constexpr auto operator<=>(const ProxyPair&, const ProxyPair&) = default;
};

/// How a proxy is expected to behave: mobile like a body, or resting like a wall. A hint that saves work and
/// never changes a result: a resting proxy may move, a mobile proxy that stays unchanged comes to rest by
/// itself.
enum class Mobility : std::uint8_t { mobile, resting };

namespace detail {

/// A hash for ids with an index and a generation. Different ids have different numbers to hash.
template <class Id>
struct IdHash {
    [[nodiscard]] std::size_t operator()(const Id& id) const noexcept {
        return std::hash<std::uint64_t>{}(std::uint64_t{id.generation} << 32 | id.index);
    }
};

}  // namespace detail
}  // namespace hashphase

/// For keys of std::unordered_map. Data about every proxy is better kept in an array by ProxyId::index.
template <>
struct std::hash<hashphase::ProxyId> : hashphase::detail::IdHash<hashphase::ProxyId> {};
