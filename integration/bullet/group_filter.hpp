// SPDX-License-Identifier: Zlib
#pragma once

// A query filter that uses Bullet's groups and masks.

#include <broadphase/proxy_id.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A ProxyFilter by Bullet's rule. Accepts a proxy if its group is in the mask of the asker (which makes the query),
/// and the asker's group is in the proxy's mask:
///
///     const GroupFilter enemies(broadphase, {.mask = kEnemyGroup});
///     const Picked<btScalar> picked = pickNearest(broadphase.grid(), ray, enemies);
///
/// Each call reads the proxy's group and mask again. The broadphase must outlive the filter. Cost: O(1). Threads: any
/// number at the same time.
class GroupFilter {
public:
    /// The asker's group and mask, like m_collisionFilterGroup and m_collisionFilterMask of a ray callback. By
    /// default, the asker is in all groups and accepts all groups.
    struct Asker {
        int group = btBroadphaseProxy::AllFilter;  ///< groups of the object that asks
        int mask = btBroadphaseProxy::AllFilter;   ///< groups that this object accepts
    };

    GroupFilter(const SpatialHashBroadphase& broadphase, const Asker& asker) noexcept
        : broadphase_(&broadphase), asker_(asker) {}
    GroupFilter(const SpatialHashBroadphase&&, const Asker&) = delete;

    /// Returns whether the groups and masks of asker and proxy accept each other. Asserted: the proxy is alive.
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
