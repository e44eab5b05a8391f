// SPDX-License-Identifier: Zlib
#pragma once

#include <cstdint>

namespace hashphase {

/// With whom a proxy may pair: two may where the group of each has a bit in the mask of the other.
/// By default with everything that has any bits; one without group or mask with nothing.
struct ProxyGroups {
    std::uint32_t group = ~std::uint32_t{0};
    std::uint32_t mask = ~std::uint32_t{0};

    friend constexpr bool operator==(const ProxyGroups&, const ProxyGroups&) = default;
};

[[nodiscard]] constexpr bool mayPair(const ProxyGroups& a, const ProxyGroups& b) noexcept {
    return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

}  // namespace hashphase
