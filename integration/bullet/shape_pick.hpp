// SPDX-License-Identifier: Zlib
#pragma once

// Picking in a Bullet world by the shapes of its objects. Camera converts a pixel to a picking ray (a RayRegion). To
// pick by boxes, or to select with a dragged rectangle, use SpatialHashBroadphase::grid().
//
// Worlds   Clients of the broadphase must be btCollisionObjects. Rays ignore proxies without a client.
// Boxes    Only objects whose boxes the ray meets are tested. After you move a body by hand, call
//          btCollisionWorld::updateSingleAabb() for its box.
// Threads  Any number of threads may pick at the same time.

#include <broadphase/collectors.hpp>
#include <broadphase/proxy_filter.hpp>
#include <broadphase/regions.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <optional>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Finds where a ray hits the shape of a proxy's object. It is an ExactTest for pickNearest() and pickAll() of
/// integration/picking/pick.hpp. The broadphase must outlive the test.
class HASHPHASE_BULLET_EXPORT ShapeTest {
public:
    explicit ShapeTest(const SpatialHashBroadphase& broadphase) noexcept
        : broadphase_(&broadphase) {}
    explicit ShapeTest(const SpatialHashBroadphase&&) = delete;

    /// Returns the hit of btCollisionWorld::rayTestSingle(), as a fraction of the ray's length. If no hit is below
    /// `limit`, returns nothing. Ignores the ray's fatness. Bullet may report a hit up to 0.02 units in front of the
    /// proxy's box. In that case, returns the fraction at which the ray enters the box. Asserted: the proxy is alive.
    [[nodiscard]] std::optional<btScalar> operator()(ProxyId id, const RayRegion<btScalar>& ray,
                                                     btScalar limit) const;

private:
    const SpatialHashBroadphase* broadphase_;
};

/// Returns the proxy of the nearest object whose shape the ray hits. Ignores the ray's fatness. The key is the hit's
/// fraction of the ray's length. Returns a null id if nothing is hit. SpatialHashBroadphase::closestRay() finds the
/// same object, and also reports the normal at the hit.
[[nodiscard]] HASHPHASE_BULLET_EXPORT KeyedProxy<btScalar> closestShape(
    const SpatialHashBroadphase& broadphase, const RayRegion<btScalar>& ray,
    ProxyFilter filter = acceptAll);

/// Casts a ray at the shape of the proxy's object. Does nothing if the proxy has no object, or
/// callback.needsCollision() returns false. Asserted: the proxy is alive.
HASHPHASE_BULLET_EXPORT void castAtShape(const SpatialHashBroadphase& broadphase, ProxyId id,
                                         const btVector3& from, const btVector3& to,
                                         btCollisionWorld::RayResultCallback& callback);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
