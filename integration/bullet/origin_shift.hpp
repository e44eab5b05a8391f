// SPDX-License-Identifier: Zlib
#pragma once

// Moves the origin of a whole Bullet world. Far from the origin numbers are coarse: bodies jitter and joints drift.
// Shift the origin now and then to keep it near the player. Contacts stay, and no body wakes.
//
// A frame  Call it between two steps.
// Shift    Use multiples of a power of two, such as 1024 m, towards the bodies. Then nothing is rounded there, and
//          relative positions stay equal to the bit.
// Threads  Needs the world for itself.
// Memory   Throws std::bad_alloc when memory runs out, and shifts nothing.
// Misuse   Asserted: the broadphase is the world's, the shift is finite, and there are no soft bodies or
//          multibodies, whose coordinates are not known here. Otherwise returns false and shifts nothing.
// RTTI     Only a btCollisionWorld needs it, to show whether it is a btDynamicsWorld. Without RTTI (-fno-rtti,
//          MSVC) it must have no rigid bodies. Asserted, as above.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Moves the world's origin to `shift` [m]: subtracts it from the transforms of collision objects and their
/// interpolation, from motion states, contact points, joints between a body and the world, and the broadphase's
/// boxes. Velocities, sleep, contacts and pairs stay. Reads and sets each motion state, even if its body rests.
/// Shift all else yourself: bodies outside the world, zones, cameras, terrains.
/// Returns whether the world was shifted; if not, nothing has changed. Cost: a look at each object, contact and
/// joint, and SpatialHashBroadphase::shiftOrigin().
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btDynamicsWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);
/// Shifts a world of any type: see RTTI above.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btCollisionWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

[[nodiscard]] bool shiftWorldWithoutJoints(btCollisionWorld& world,
                                           SpatialHashBroadphase& broadphase,
                                           const btVector3& shift);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
