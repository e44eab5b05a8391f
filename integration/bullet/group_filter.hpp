// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's groups and masks for queries that go to the grid.

#include <broadphase/proxy_id.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A ProxyFilter by Bullet's rule: accepts a proxy when its group is in `mask` and `group` is in its
/// mask, as for a body with this group and mask, or for a ray callback's m_collisionFilterGroup and
/// m_collisionFilterMask. Sees changes of a proxy's group and mask at once. The broadphase must
/// outlive the filter. Any number of threads.
class GroupFilter {
public:
    explicit GroupFilter(const SpatialHashBroadphase& broadphase,
                         int group = btBroadphaseProxy::AllFilter,
                         int mask = btBroadphaseProxy::AllFilter) noexcept
        : broadphase_(&broadphase), group_(group), mask_(mask) {}

    [[nodiscard]] bool operator()(ProxyId id) const {
        const btBroadphaseProxy* proxy = broadphase_->proxyOf(id);
        return (proxy->m_collisionFilterGroup & mask_) != 0 &&
               (group_ & proxy->m_collisionFilterMask) != 0;
    }

private:
    const SpatialHashBroadphase* broadphase_;
    int group_;
    int mask_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
