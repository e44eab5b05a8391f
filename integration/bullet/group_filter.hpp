// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's groups and masks for queries that go to the grid.

#include <broadphase/proxy_id.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A ProxyFilter by Bullet's rule: accepts proxies whose group is in `mask`, and whose mask has `group`,
/// that of whoever asks. As for a ray callback's m_collisionFilterMask and m_collisionFilterGroup. Sees
/// changes of a proxy's group and mask at once. The broadphase must outlive the filter. Any number of
/// threads.
class GroupFilter {
public:
    explicit GroupFilter(const SpatialHashBroadphase& broadphase, int mask,
                         int group = btBroadphaseProxy::AllFilter) noexcept
        : broadphase_(&broadphase), mask_(mask), group_(group) {}
    GroupFilter(const SpatialHashBroadphase&&, int, int = 0) = delete;

    [[nodiscard]] bool operator()(ProxyId id) const {
        const btBroadphaseProxy* proxy = broadphase_->proxyOf(id);
        return (proxy->m_collisionFilterGroup & mask_) != 0 &&
               (group_ & proxy->m_collisionFilterMask) != 0;
    }

private:
    const SpatialHashBroadphase* broadphase_;
    int mask_;
    int group_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
