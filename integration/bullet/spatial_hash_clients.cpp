// SPDX-License-Identifier: Zlib

// What the broadphase does for the objects behind its proxies: ghosts, and shapes that change.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// Bullet, too, takes a client for a btCollisionObject when it tells ghosts, or a dispatcher, of a pair: what
// can have none may be anything. What a client is never changes.
bool SpatialHashBroadphase::isGhost(Proxy& proxy, const btDispatcher* dispatcher) {
    const bool mayPair = proxy.m_collisionFilterGroup != 0 && proxy.m_collisionFilterMask != 0;
    if (proxy.client == Client::unknown && dispatcher != nullptr && mayPair &&
        proxy.m_clientObject != nullptr) {
        const auto& object = *static_cast<const btCollisionObject*>(proxy.m_clientObject);
        const bool isGhost = object.getInternalType() == btCollisionObject::CO_GHOST_OBJECT;
        if (isGhost) {
            proxy.ghostAt = static_cast<std::uint32_t>(ghosts_.size());
            ghosts_.push_back(proxy.id.index);
        }
        proxy.client = isGhost ? Client::ghost : Client::other;
    }
    return proxy.client == Client::ghost;
}

void SpatialHashBroadphase::forgetGhost(Proxy& proxy) noexcept {
    proxyAt(ghosts_.back())->ghostAt = proxy.ghostAt;
    ghosts_[proxy.ghostAt] = ghosts_.back();
    ghosts_.pop_back();
}

// Where there are many, to ask about its pairs is sooner than to look at each.
bool SpatialHashBroadphase::mayMeetGhosts(const Proxy& proxy) const {
    constexpr std::size_t kFew = 1024;
    const auto touches = [&](std::uint32_t slot) {
        return overlaps(grid_.box(proxyAt(slot)->id), grid_.box(proxy.id));
    };
    return mayHaveGhosts() &&
           (ghosts_.size() > kFew || std::any_of(ghosts_.begin(), ghosts_.end(), touches));
}

void SpatialHashBroadphase::shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    checkMayChange();
    Proxy* own = checkedProxy(proxy);
    if (batchCache_ != nullptr) {
        batchCache_->renewPairsContainingProxy(own, dispatcher);
        return;
    }
    if (pairCache_->hasDeferredRemoval()) {
        pairCache_->cleanProxyFromPairs(own, dispatcher);
        return;
    }
    std::vector<ProxyCouple> couples;
    const btBroadphasePairArray& pairs = pairCache_->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        if (pairs[i].m_pProxy0 == own || pairs[i].m_pProxy1 == own) {
            couples.emplace_back(*pairs[i].m_pProxy0, *pairs[i].m_pProxy1);
        }
    }
    for (const ProxyCouple& couple : couples) {
        if (couple.isUpToDate()) {  // a callback may have destroyed one of the two
            pairCache_->removeOverlappingPair(couple.lower(), couple.upper(), dispatcher);
        }
        if (couple.isUpToDate()) {
            pairCache_->addOverlappingPair(couple.lower(), couple.upper());
        }
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
