// SPDX-License-Identifier: Zlib
#pragma once

// Ids of the proxies of a grid. A proxy represents an object of the caller by its box.
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

/// Names one proxy of one grid. ProxyId{} is null. Ordered by index, then by generation.
struct ProxyId {
    /// Small and dense, for the caller's own data in arrays by index. Below the largest number of proxies ever alive
    /// at once; removed ones count until the next update.
    std::uint32_t index = 0;
    /// Distinguishes a proxy from earlier ones with the same index.
    std::uint32_t generation = 0;

    /// True for ProxyId{}, which names no proxy. The id of a removed proxy is not null: see Grid::contains().
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ProxyId&, const ProxyId&) = default;
};

/// A pair of proxies, first.index < second.index. Ordered by first, then by second.
struct ProxyPair {
    ProxyId first;
    ProxyId second;

    friend constexpr auto operator<=>(const ProxyPair&, const ProxyPair&) = default;
};

/// How a proxy is expected to behave: mobile like a body, or resting like a wall. A hint that changes no result: a
/// resting proxy may move, and an unchanged mobile one comes to rest.
enum class Mobility : std::uint8_t { mobile, resting };

namespace detail {

/// A hash for ids with an index and a generation.
template <class Id>
struct IdHash {
    [[nodiscard]] std::size_t operator()(const Id& id) const noexcept {
        return std::hash<std::uint64_t>{}(std::uint64_t{id.generation} << 32 | id.index);
    }
};

}  // namespace detail
}  // namespace hashphase

/// For keys of std::unordered_map. For data about every proxy, prefer an array by ProxyId::index.
template <>
struct std::hash<hashphase::ProxyId> : hashphase::detail::IdHash<hashphase::ProxyId> {};
