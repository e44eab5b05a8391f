// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's groups and masks for queries that go to the grid.

#include <broadphase/proxy_id.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A ProxyFilter by Bullet's rule: accepts proxies whose group is in the mask of whoever asks, and whose
/// mask has that one's group:
///
///     const GroupFilter enemies(broadphase, {.mask = kEnemyGroup});
///
/// Sees changes of a proxy's group and mask at once. The broadphase must outlive the filter. Any number of
/// threads.
class GroupFilter {
public:
    /// Who asks, as a ray callback's m_collisionFilterGroup and m_collisionFilterMask say.
    struct Asker {
        int group = btBroadphaseProxy::AllFilter;
        int mask = btBroadphaseProxy::AllFilter;
    };

    GroupFilter(const SpatialHashBroadphase& broadphase, const Asker& asker) noexcept
        : broadphase_(&broadphase), asker_(asker) {}
    GroupFilter(const SpatialHashBroadphase&&, const Asker&) = delete;

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
