// SPDX-License-Identifier: Zlib
#pragma once

// Who is near a point, found by measuring to everybody.

#include <broadphase/collectors.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <tests/support/oracles.hpp>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <span>
#include <vector>

namespace hashphase {

// For GoogleTest.
template <class Scalar>
void PrintTo(const KeyedProxy<Scalar>& proxy, std::ostream* out) {
    PrintTo(proxy.id, out);
    *out << " at " << proxy.key;
}

}  // namespace hashphase

namespace hashphase::test {

template <class Scalar, class Region>
void findInByBruteForce(std::span<const Placed<Scalar>> proxies, const Region& region,
                        std::vector<ProxyId>& found, ProxyFilter filter, ProxyId self = {}) {
    found.clear();
    for (const Placed<Scalar>& proxy : proxies) {
        if (region.key(proxy.box) >= 0 && proxy.id != self && filter(proxy.id)) {
            found.push_back(proxy.id);
        }
    }
    std::sort(found.begin(), found.end());
}

template <class Scalar>
void findWithinByBruteForce(std::span<const Placed<Scalar>> proxies,
                            const Vector3<Scalar>& position, Scalar radius,
                            std::vector<ProxyId>& found, ProxyFilter filter = acceptAll,
                            ProxyId self = {}) {
    const PositionRegion<Scalar> ball(position, radius);
    findInByBruteForce(proxies, ball, found, filter, self);
}

template <class Scalar>
void findNearestByBruteForce(std::span<const Placed<Scalar>> proxies, const Vector3<Scalar>& point,
                             std::size_t count, Scalar maximalDistance,
                             std::vector<KeyedProxy<Scalar>>& nearest,
                             ProxyFilter filter = acceptAll, ProxyId self = {}) {
    const PositionRegion<Scalar> ball(point, maximalDistance);
    nearest.clear();
    for (const Placed<Scalar>& proxy : proxies) {
        if (ball.key(proxy.box) >= 0 && proxy.id != self && filter(proxy.id)) {
            nearest.push_back({ball.key(proxy.box), proxy.id});
        }
    }
    std::sort(nearest.begin(), nearest.end());
    nearest.resize(std::min(nearest.size(), count));
}

}  // namespace hashphase::test
