// SPDX-License-Identifier: Zlib
#pragma once

// Picking in a Bullet world by the shapes of its objects. A picking ray is a RayRegion, which Camera makes
// of a pixel. Picking by boxes and drag selection work on SpatialHashBroadphase::grid() as they are.
//
// Worlds   The clients of the broadphase are btCollisionObjects; a ray passes proxies without a client.
// Boxes    Only objects whose boxes the ray meets are asked: after moving a body by hand, set its box by
//          btCollisionWorld::updateSingleAabb().
// Threads  any number at the same time

#include <broadphase/collectors.hpp>
#include <broadphase/proxy_filter.hpp>
#include <broadphase/regions.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <optional>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Where a ray meets the shape of a proxy's object: an ExactTest for pickNearest() and pickAll() of
/// integration/picking/pick.hpp. The broadphase must outlive the test.
class HASHPHASE_BULLET_EXPORT ShapeTest {
public:
    explicit ShapeTest(const SpatialHashBroadphase& broadphase) noexcept
        : broadphase_(&broadphase) {}
    explicit ShapeTest(const SpatialHashBroadphase&&) = delete;

    /// Returns the fraction of the ray's length, below the limit, that btCollisionWorld::rayTestSingle()
    /// finds for the ray without its fatness. Bullet's cast may end up to 2 cm in front of the proxy's box:
    /// then it returns the fraction at which the ray enters the box.
    [[nodiscard]] std::optional<btScalar> operator()(ProxyId id, const RayRegion<btScalar>& ray,
                                                     btScalar limit) const;

private:
    const SpatialHashBroadphase* broadphase_;
};

/// Returns the nearest object that the ray meets by its shape, and the fraction of the ray's length as its
/// key; a null id when there is none. SpatialHashBroadphase::closestRay() finds the same object, and a
/// normal.
[[nodiscard]] HASHPHASE_BULLET_EXPORT KeyedProxy<btScalar> closestShape(
    const SpatialHashBroadphase& broadphase, const RayRegion<btScalar>& ray,
    ProxyFilter filter = acceptAll);

/// Casts a ray at the shape of a proxy's object, when there is one and the callback's
/// needsCollision() wants it.
HASHPHASE_BULLET_EXPORT void castAtShape(const SpatialHashBroadphase& broadphase, ProxyId id,
                                         const btVector3& from, const btVector3& to,
                                         btCollisionWorld::RayResultCallback& callback);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
