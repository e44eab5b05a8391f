// SPDX-License-Identifier: Zlib
#pragma once

// How a rigid body is going to move in the present step, as the broadphase sees it.

#include <broadphase/moving_box.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include <optional>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// The box and the displacement [m] of the proxy's rigid body from where it is to where Bullet has
/// predicted it, during a step; nothing when the proxy's client is no dynamic rigid body, or moves by
/// no more than `share` of the smallest edge of its box. The box is as large as it takes to cover the
/// body at either end, whichever way it turns, with Bullet's contact margin around it; in between,
/// turning is not looked at. The client must be null or a btCollisionObject.
[[nodiscard]] std::optional<MovingBox<btScalar>> fastMotion(const btBroadphaseProxy& proxy,
                                                            btScalar share);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
