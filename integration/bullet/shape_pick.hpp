// SPDX-License-Identifier: Zlib
#pragma once

// Picking in a Bullet world by the shapes of its objects. Camera makes the picking ray, a RayRegion, from a pixel.
// To pick by boxes, or to select by dragging, use SpatialHashBroadphase::grid().
//
// Worlds   Clients of the broadphase are btCollisionObjects. A ray passes through proxies without a client.
// Boxes    Only objects whose boxes the ray meets are tested. After you move a body by hand, call
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

/// Finds where a ray meets the shape of a proxy's object: an ExactTest for pickNearest() and pickAll() of
/// integration/picking/pick.hpp. The broadphase must outlive the test.
class HASHPHASE_BULLET_EXPORT ShapeTest {
public:
    explicit ShapeTest(const SpatialHashBroadphase& broadphase) noexcept
        : broadphase_(&broadphase) {}
    explicit ShapeTest(const SpatialHashBroadphase&&) = delete;

    /// Returns the hit below `limit`, as a fraction of the ray's length, that btCollisionWorld::rayTestSingle()
    /// finds for the ray without its fatness; nothing if there is none. Bullet's cast may end up to 2 cm in front
    /// of the proxy's box: then returns the fraction at which the ray enters the box. Asserted: the proxy is alive.
    [[nodiscard]] std::optional<btScalar> operator()(ProxyId id, const RayRegion<btScalar>& ray,
                                                     btScalar limit) const;

private:
    const SpatialHashBroadphase* broadphase_;
};

/// Returns the nearest object whose shape the ray meets, with the fraction of the ray's length as its key; a null
/// id if there is none. SpatialHashBroadphase::closestRay() finds the same object, and a normal.
[[nodiscard]] HASHPHASE_BULLET_EXPORT KeyedProxy<btScalar> closestShape(
    const SpatialHashBroadphase& broadphase, const RayRegion<btScalar>& ray,
    ProxyFilter filter = acceptAll);

/// Casts a ray at the shape of the proxy's object, if there is one and callback.needsCollision() accepts it.
/// Asserted: the proxy is alive.
HASHPHASE_BULLET_EXPORT void castAtShape(const SpatialHashBroadphase& broadphase, ProxyId id,
                                         const btVector3& from, const btVector3& to,
                                         btCollisionWorld::RayResultCallback& callback);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
