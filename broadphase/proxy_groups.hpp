// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <cstdint>

namespace hashphase {

/// The groups of a proxy, and the groups that it may pair with: see mayPair() and Grid::setGroups(). Your program
/// defines the bits. By default, all proxies may pair. A proxy whose group or mask is 0 pairs with no proxy.
///
///     constexpr std::uint32_t kWalls = 1, kBullets = 2;
///     grid.setGroups(bullet, {.group = kBullets, .mask = kWalls});  // bullets ignore each other
struct ProxyGroups {
    std::uint32_t group = ~std::uint32_t{0};  ///< bits of the groups that the proxy is in
    std::uint32_t mask = ~std::uint32_t{0};   ///< bits of the groups that the proxy may pair with

    friend constexpr bool operator==(const ProxyGroups&, const ProxyGroups&) = default;
};

/// True when the group of each proxy shares a bit with the other proxy's mask, as in Bullet.
[[nodiscard]] constexpr bool mayPair(const ProxyGroups& a, const ProxyGroups& b) noexcept {
    return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

}  // namespace hashphase
