// SPDX-License-Identifier: Zlib

// Which of the objects behind the proxies are ghosts, and where they are.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/regions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

bool SpatialHashBroadphase::isGhost(Proxy& proxy, const btDispatcher* dispatcher) {
    if (canClientBeLookedAt(proxy, dispatcher)) {
        const auto& object = *static_cast<const btCollisionObject*>(proxy.m_clientObject);
        const bool isGhost = object.getInternalType() == btCollisionObject::CO_GHOST_OBJECT;
        if (isGhost) {
            if (ghosts_ == nullptr) {
                ghosts_ = std::make_unique<detail::FlatSet>();
            }
            ghosts_->findOrInsert(proxy.id.index);
        }
        proxy.client = isGhost ? Client::ghost : Client::other;
    }
    return proxy.client == Client::ghost;
}

// Those that the proxy touches. Where there are many, to ask who is there is sooner than to look at each.
std::vector<ProxyId> SpatialHashBroadphase::ghostsAt(const Proxy& proxy) const {
    constexpr std::size_t kFew = 1024;
    std::vector<ProxyId> found;
    if (!mayHaveGhosts()) {
        return found;
    }
    const Aabb<btScalar> box = grid_.box(proxy.id);
    if (ghostCount() > kFew) {
        CollectAll all(found);
        grid_.visit(BoxRegion<btScalar>{box}, all);
        std::erase_if(found,
                      [this](ProxyId id) { return proxyAt(id.index)->client != Client::ghost; });
        return found;
    }
    for (std::size_t i = 0; i < ghostCount(); ++i) {
        const ProxyId ghost = proxyAt(static_cast<std::uint32_t>(ghosts_->keys()[i]))->id;
        if (overlaps(grid_.box(ghost), box)) {
            found.push_back(ghost);
        }
    }
    return found;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
