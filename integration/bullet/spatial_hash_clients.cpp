// SPDX-License-Identifier: Zlib

// Which of the objects behind the proxies are ghosts, where they are, and what a box that is set may do there.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/lone_moves.inl>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/collectors.hpp>
#include <broadphase/regions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <limits>
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

// --- A box where more than it may change ----------------------------------------------------------

void SpatialHashBroadphase::setAnyAabb(Proxy& proxy, const btVector3& aabbMin,
                                       const btVector3& aabbMax, btScalar margin,
                                       btDispatcher* dispatcher) {
    const Aabb<btScalar> box = toAabb(aabbMin, aabbMax);
    const Aabb<btScalar> before = toAabb(proxy.m_aabbMin, proxy.m_aabbMax);
    const bool isSame = isSameBits(before, box) && margin == proxy.margin;
    const bool jumps = !isSame && ghostCount() > 0 && !overlaps(before, box);
    // A body that flies back may have the same box as when it came.
    if (!isSame || sweeps_ != nullptr) {
        proxy.m_aabbMin = aabbMin;
        proxy.m_aabbMax = aabbMax;
        proxy.margin = margin;
        move(proxy, grown(box, margin));
        changedKinds_ |= detail::GroupKinds::bit(proxy.kind);
    }
    const bool isRegrouped = !areGroupsKnown(proxy) && noteGroups(proxy);
    if (!seen_.empty()) {
        noteSeen(proxy, true);
    }
    if ((!isSame || isRegrouped) && isEager(proxy, dispatcher)) {
        findPairsNow(proxy, dispatcher);
    } else if (jumps) {
        findGhostPairsNow(proxy, dispatcher);
    }
}

void SpatialHashBroadphase::setMargin(btBroadphaseProxy* proxy, btScalar margin,
                                      btDispatcher* dispatcher) {
    checkMayChange();
    Proxy* const own = checkedProxy(proxy);
    const bool isGood = margin >= 0 && margin <= std::numeric_limits<btScalar>::max();
    HASHPHASE_ASSERT(isGood,
                     "setMargin(): the margin is negative, NaN or infinite. Pass a finite margin "
                     "of 0 m or more.");
    if (!own->id.isNull() && isGood) {
        mayGrow_ = mayGrow_ || margin != 0;
        setAnyAabb(*own, own->m_aabbMin, own->m_aabbMax, margin, dispatcher);
    }
}

btScalar SpatialHashBroadphase::margin(const btBroadphaseProxy* proxy) const {
    return checkedProxy(const_cast<btBroadphaseProxy*>(proxy))->margin;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
