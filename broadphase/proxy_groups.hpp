// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/export.hpp>
#include <cstdint>

namespace hashphase {

/// Which proxies a proxy may pair with: see mayPair(), and Grid::setGroups() for how pairs follow. Bits mean
/// what the program likes. By default a proxy may pair with every other one whose group and mask are not 0. A
/// proxy whose group or mask is 0 pairs with none.
///
///     constexpr std::uint32_t kWalls = 1, kBullets = 2;
///     grid.setGroups(bullet, {.group = kBullets, .mask = kWalls});  // bullets ignore each other
struct ProxyGroups {
    std::uint32_t group = ~std::uint32_t{0};  ///< bits of the groups that the proxy is in
    std::uint32_t mask = ~std::uint32_t{0};   ///< bits of the groups that it may pair with

    friend constexpr bool operator==(const ProxyGroups&, const ProxyGroups&) = default;
};

/// True when the group of each has a bit in the mask of the other: Bullet's rule.
[[nodiscard]] constexpr bool mayPair(const ProxyGroups& a, const ProxyGroups& b) noexcept {
    return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

}  // namespace hashphase
