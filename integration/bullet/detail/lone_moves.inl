// SPDX-License-Identifier: Zlib
#pragma once

// Which boxes are set without anything else happening: inline, as setAabb() asks for each of them.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

inline std::size_t SpatialHashBroadphase::ghostCount() const noexcept {
    return ghosts_ != nullptr ? ghosts_->size() : 0;
}

// A margin of 0 changes no bit, not even that of a negative zero.
inline Aabb<btScalar> SpatialHashBroadphase::grown(const Aabb<btScalar>& box, btScalar margin) {
    if (margin == 0) {
        return box;
    }
    const Vector3<btScalar> by = Vector3<btScalar>::Constant(margin);
    return {box.min() - by, box.max() + by};
}

// Mostly they are what they were: then this is but a comparison.
inline bool SpatialHashBroadphase::areGroupsKnown(const Proxy& proxy) const noexcept {
    return !groupsDecide_ ||
           (proxy.kind != detail::GroupKinds::kOther && groupKinds_[proxy.kind] == groupsOf(proxy));
}

// Bullet, too, takes a client for a btCollisionObject when it tells ghosts, or a dispatcher, of a pair: what
// can have none may be anything. What a client is never changes.
inline bool SpatialHashBroadphase::canClientBeLookedAt(const Proxy& proxy,
                                                       const btDispatcher* dispatcher) noexcept {
    const bool mayPair = proxy.m_collisionFilterGroup != 0 && proxy.m_collisionFilterMask != 0;
    return proxy.client == Client::unknown && dispatcher != nullptr && mayPair &&
           proxy.m_clientObject != nullptr;
}

inline bool SpatialHashBroadphase::mayBeEager(const Proxy& proxy,
                                              const btDispatcher* dispatcher) const {
    return (proxy.m_collisionFilterGroup & config_.eagerGroups) != 0 ||
           (proxy.client != Client::other && mayHaveGhosts() &&
            (proxy.client == Client::ghost || canClientBeLookedAt(proxy, dispatcher)));
}

inline bool SpatialHashBroadphase::isEager(Proxy& proxy, const btDispatcher* dispatcher) {
    return (proxy.m_collisionFilterGroup & config_.eagerGroups) != 0 ||
           (proxy.client != Client::other && mayHaveGhosts() && isGhost(proxy, dispatcher));
}

inline bool SpatialHashBroadphase::movesAlone(const Proxy& proxy, const btVector3& aabbMin,
                                              const btVector3& aabbMax,
                                              const btDispatcher* dispatcher) const {
    return !mayBeEager(proxy, dispatcher) &&
           (ghostCount() == 0 ||
            overlaps(toAabb(proxy.m_aabbMin, proxy.m_aabbMax), toAabb(aabbMin, aabbMax)));
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
