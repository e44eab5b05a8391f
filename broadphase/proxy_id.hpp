// SPDX-License-Identifier: Zlib
#pragma once

// Ids of the proxies of a grid. A proxy is the box of one of your objects.
//
//     const ProxyId id = grid.add(box);
//     objects.resize(grid.indexLimit());
//     objects[id.index] = &object;  // your data at this index

#include <broadphase/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hashphase {

/// Identifies one proxy of one grid. ProxyId{} is null. Ids are ordered by index, then by generation.
struct ProxyId {
    /// Small and dense: use it as an index into your own arrays. It is below the largest number of proxies that were
    /// ever alive at the same time, where a removed proxy counts as alive until the next update.
    std::uint32_t index = 0;
    /// Distinguishes a proxy from earlier proxies with the same index.
    std::uint32_t generation = 0;

    /// True for ProxyId{}, the id of no proxy. The id of a removed proxy is not null: see Grid::contains().
    [[nodiscard]] constexpr bool isNull() const noexcept { return generation == 0; }
    friend constexpr auto operator<=>(const ProxyId&, const ProxyId&) = default;
};

/// A pair of proxies, with first.index < second.index. Pairs are ordered by `first`, then by `second`.
struct ProxyPair {
    ProxyId first;
    ProxyId second;

    friend constexpr auto operator<=>(const ProxyPair&, const ProxyPair&) = default;
};

/// How a proxy will probably behave: mobile like a body, or resting like a wall. This hint changes no result: a
/// resting proxy may move, and the grid soon treats an unchanged mobile proxy as resting.
enum class Mobility : std::uint8_t { mobile, resting };

namespace detail {

/// A hash function for ids with an index and a generation.
template <class Id>
struct IdHash {
    [[nodiscard]] std::size_t operator()(const Id& id) const noexcept {
        return std::hash<std::uint64_t>{}(std::uint64_t{id.generation} << 32 | id.index);
    }
};

}  // namespace detail
}  // namespace hashphase

/// Makes ProxyId a key of std::unordered_map. For data about every proxy, prefer an array that is indexed by
/// ProxyId::index.
template <>
struct std::hash<hashphase::ProxyId> : hashphase::detail::IdHash<hashphase::ProxyId> {};
