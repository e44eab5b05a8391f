// SPDX-License-Identifier: Zlib
#pragma once

// Picking in a Bullet world by the shapes of its objects. A picking ray is a RayRegion, as a Camera makes
// one of a pixel; picking by boxes and drag selection work on SpatialHashBroadphase::grid() as they are.
//
// Worlds   whose clients are btCollisionObjects; proxies without a client are not met
// Boxes    Only objects whose boxes are met are asked: a body that was moved by hand needs its box
//          set, by btCollisionWorld::updateSingleAabb().
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

    /// The fraction of the ray's length, below the limit, that btCollisionWorld::rayTestSingle() has
    /// for the ray without its fatness; where that cast ends in front of the proxy's box, as it may by
    /// up to 2 cm, the fraction at which the ray enters the box.
    [[nodiscard]] std::optional<btScalar> operator()(ProxyId id, const RayRegion<btScalar>& ray,
                                                     btScalar limit) const;

private:
    const SpatialHashBroadphase* broadphase_;
};

/// The nearest object that the ray meets by its shape, and at what fraction of the ray's length; null
/// when there is none. What closestRay() finds, which also has a normal to tell.
[[nodiscard]] HASHPHASE_BULLET_EXPORT KeyedProxy<btScalar> closestShape(
    const SpatialHashBroadphase& broadphase, const RayRegion<btScalar>& ray,
    ProxyFilter filter = acceptAll);

/// Casts a ray at the shape of a proxy's object, when there is one and the callback's
/// needsCollision() wants it.
HASHPHASE_BULLET_EXPORT void castAtShape(const SpatialHashBroadphase& broadphase, ProxyId id,
                                         const btVector3& from, const btVector3& to,
                                         btCollisionWorld::RayResultCallback& callback);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
