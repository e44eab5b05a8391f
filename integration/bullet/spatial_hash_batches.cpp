// SPDX-License-Identifier: Zlib
//
// Many proxies at once, with the result of as many single calls.

#include <broadphase/detail/prefetch.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

void SpatialHashBroadphase::createProxies(std::span<const ProxyDefinition> definitions,
                                          std::span<btBroadphaseProxy*> proxies,
                                          btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(definitions.size() == proxies.size(),
                     "There is room for exactly one proxy a definition.");
    std::transform(definitions.begin(), definitions.end(), proxies.begin(),
                   [&](const ProxyDefinition& each) { return create(each, dispatcher); });
}

void SpatialHashBroadphase::setAabbs(std::span<btBroadphaseProxy* const> proxies,
                                     std::span<const btVector3> aabbMins,
                                     std::span<const btVector3> aabbMaxs,
                                     btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(proxies.size() == aabbMins.size() && proxies.size() == aabbMaxs.size(),
                     "There is exactly one box a proxy.");
    constexpr std::size_t kAhead = 8;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        if (i + kAhead < proxies.size()) {
            detail::prefetch(proxies[i + kAhead]);
        }
        setAabb(proxies[i], aabbMins[i], aabbMaxs[i], dispatcher);
    }
}

void SpatialHashBroadphase::destroyProxies(std::span<btBroadphaseProxy* const> proxies,
                                           btDispatcher* dispatcher) {
    for (btBroadphaseProxy* proxy : proxies) {
        static_cast<void>(checkedProxy(proxy));
    }
    if (batchCache_ != nullptr) {
        batchCache_->removeOverlappingPairsContainingProxies(proxies, dispatcher);
    } else {
        for (btBroadphaseProxy* proxy : proxies) {
            pairCache_->removeOverlappingPairsContainingProxy(proxy, dispatcher);
        }
    }
    // The second time that a proxy is named it is not alive any more, which is asserted.
    for (btBroadphaseProxy* proxy : proxies) {
        removeFromGrid(checkedProxy(proxy));
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
