// SPDX-License-Identifier: Zlib

// Which of the objects behind the proxies are ghosts, and where they are.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/regions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// Bullet, too, takes a client for a btCollisionObject when it tells ghosts, or a dispatcher, of a pair: what
// can have none may be anything. What a client is never changes.
bool SpatialHashBroadphase::canClientBeLookedAt(const Proxy& proxy,
                                                const btDispatcher* dispatcher) noexcept {
    const bool mayPair = proxy.m_collisionFilterGroup != 0 && proxy.m_collisionFilterMask != 0;
    return proxy.client == Client::unknown && dispatcher != nullptr && mayPair &&
           proxy.m_clientObject != nullptr;
}

bool SpatialHashBroadphase::isGhost(Proxy& proxy, const btDispatcher* dispatcher) {
    if (canClientBeLookedAt(proxy, dispatcher)) {
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

// Those that the proxy touches. Where there are many, to ask who is there is sooner than to look at each.
std::vector<ProxyId> SpatialHashBroadphase::ghostsAt(const Proxy& proxy) const {
    constexpr std::size_t kFew = 1024;
    std::vector<ProxyId> found;
    if (!mayHaveGhosts()) {
        return found;
    }
    const Aabb<btScalar> box = grid_.box(proxy.id);
    if (ghosts_.size() > kFew) {
        CollectAll all(found);
        grid_.visit(BoxRegion<btScalar>{box}, all);
        std::erase_if(found,
                      [this](ProxyId id) { return proxyAt(id.index)->client != Client::ghost; });
        return found;
    }
    for (const std::uint32_t slot : ghosts_) {
        const ProxyId ghost = proxyAt(slot)->id;
        if (overlaps(grid_.box(ghost), box)) {
            found.push_back(ghost);
        }
    }
    return found;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
