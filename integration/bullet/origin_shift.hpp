// SPDX-License-Identifier: Zlib
#pragma once

// Moves the origin of a whole Bullet world. Far from the origin, coordinates have large rounding errors: bodies
// jitter and joints drift. Shift the origin from time to time to keep it near the player. Contacts stay, and no body
// wakes up.
//
// When     Call shiftWorldOrigin() between two steps.
// Shift    Shift towards the bodies, by multiples of a power of two such as 1024 m. In that case, their coordinates
//          are not rounded, and relative positions keep all bits.
// Threads  No other thread may use the world during the call.
// Memory   When memory runs out, throws std::bad_alloc and shifts nothing.
// Misuse   Asserted: the world uses this broadphase, the shift is finite, and there are no soft bodies or
//          multibodies, which cannot be shifted. If a condition is broken, returns false and shifts nothing.
// Worlds   A btMultiBodyDynamicsWorld passed as a btDynamicsWorld is refused only if its multibodies have colliders.
// RTTI     The overload for btCollisionWorld needs RTTI in this library, Bullet and the world's class, to see whether
//          that world is a btDynamicsWorld. Without RTTI (-fno-rtti), and always with MSVC, that world must have no
//          rigid bodies (asserted, as above).

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

class btMultiBodyDynamicsWorld;

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Moves the world's origin to `shift` [m]. Subtracts `shift` from the transforms and interpolation transforms of
/// collision objects, from motion states, contact points, joints between a body and the world, and the broadphase's
/// boxes. Velocities and sleep states do not change. All contacts and pairs persist. Reads and sets each motion
/// state, even if its body sleeps. Shift everything else yourself, such as bodies outside the world, and hashphase's
/// Zones, Camera and Terrain. Returns whether the world was shifted. If false, nothing has changed. Cost: O(objects +
/// contacts + joints), plus SpatialHashBroadphase::shiftOrigin().
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btDynamicsWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);
/// As above. Also refuses multibodies without colliders.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btMultiBodyDynamicsWorld& world,
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
