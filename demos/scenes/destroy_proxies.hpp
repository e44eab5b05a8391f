// SPDX-License-Identifier: Zlib
#pragma once

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <span>

namespace hashphase::demos {

/// Destroys all of a broadphase's proxies that are not null. Bullet's cache searches all its pairs for those
/// of a proxy that is destroyed; emptied beforehand, it has none to search.
inline void destroyProxies(btBroadphaseInterface& broadphase,
                           std::span<btBroadphaseProxy* const> proxies) {
    auto* cache = dynamic_cast<btHashedOverlappingPairCache*>(broadphase.getOverlappingPairCache());
    while (cache != nullptr && cache->getNumOverlappingPairs() > 0) {
        const btBroadphasePair& last =
            cache->getOverlappingPairArray()[cache->getNumOverlappingPairs() - 1];
        cache->removeOverlappingPair(last.m_pProxy0, last.m_pProxy1, nullptr);
    }
    for (btBroadphaseProxy* proxy : proxies) {
        if (proxy != nullptr) {
            broadphase.destroyProxy(proxy, nullptr);
        }
    }
}

}  // namespace hashphase::demos
