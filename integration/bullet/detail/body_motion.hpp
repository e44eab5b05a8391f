// SPDX-License-Identifier: Zlib
#pragma once

// How a rigid body is going to move in the present step, as the broadphase sees it.

#include <broadphase/moving_box.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include <optional>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// A body's motion during a step, with Bullet's contact margin around it.
struct BodyMotion {
    /// The box is as large as it takes to cover the body at either end, whichever way it turns; in
    /// between, turning is not looked at.
    MovingBox<btScalar> way;
    /// Around start and end [m]: the box that Bullet hands in with m_useContinuous.
    Aabb<btScalar> bounds;
};

/// How the proxy's rigid body moves from where it is to where Bullet has predicted it; nothing when the
/// proxy's client is no dynamic rigid body, or moves by no more than `share` of the smallest edge of its
/// box. The client must be null or a btCollisionObject.
[[nodiscard]] std::optional<BodyMotion> fastMotion(const btBroadphaseProxy& proxy, btScalar share);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
