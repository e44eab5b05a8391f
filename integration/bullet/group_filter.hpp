// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's groups and masks for queries that go to the grid.

#include <broadphase/proxy_id.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A ProxyFilter by Bullet's rule: accepts proxies whose group is in the asker's mask, and whose mask has
/// the asker's group:
///
///     const GroupFilter enemies(broadphase, {.mask = kEnemyGroup});
///     const Picked<btScalar> picked = pickNearest(broadphase.grid(), ray, enemies);
///
/// Sees changes of a proxy's group and mask at once. The broadphase must outlive the filter. Any number of
/// threads may use it at the same time. Cost: O(1).
class GroupFilter {
public:
    /// The side that asks, like m_collisionFilterGroup and m_collisionFilterMask of a ray callback. By
    /// default it has all groups and wants all groups.
    struct Asker {
        int group = btBroadphaseProxy::AllFilter;  ///< groups of the asker
        int mask = btBroadphaseProxy::AllFilter;   ///< groups that the asker wants
    };

    GroupFilter(const SpatialHashBroadphase& broadphase, const Asker& asker) noexcept
        : broadphase_(&broadphase), asker_(asker) {}
    GroupFilter(const SpatialHashBroadphase&&, const Asker&) = delete;

    /// True when the two groups and masks accept each other. The proxy is alive (asserted).
    [[nodiscard]] bool operator()(ProxyId id) const {
        const btBroadphaseProxy* proxy = broadphase_->proxyOf(id);
        return (proxy->m_collisionFilterGroup & asker_.mask) != 0 &&
               (asker_.group & proxy->m_collisionFilterMask) != 0;
    }

private:
    const SpatialHashBroadphase* broadphase_;
    Asker asker_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
