// SPDX-License-Identifier: Zlib
#pragma once

// Moves the origin of a whole Bullet world. Far from the origin numbers are coarse: bodies jitter and
// joints drift. Shift the origin now and then to keep the world around the player near it; nothing falls
// apart, wakes up, or loses its contacts.
//
// A frame   Call it between two steps.
// Choose    shifts by multiples of a power of two, such as 1024 m, towards where the bodies are: they round
//           nothing there, and leave relative positions as they were, to the bit.
// Threads   needs the world for itself
// Memory    Where it runs out, std::bad_alloc is passed on, and nothing is shifted.
// Misuse    Soft bodies and multibodies keep coordinates that are not known here. A world with such bodies,
//           and a shift that is not finite, are asserted: then nothing is shifted, and false is returned.
// RTTI      None is needed for a btDynamicsWorld, or what is derived from it. A btCollisionWorld is asked
//           whether it is one; where it cannot say (-fno-rtti, MSVC) and has rigid bodies, that is asserted, too.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Moves the world's origin to `shift` [m]: subtracts it from the place of every collision object and
/// its interpolation, from the motion states of bodies, from the points of all contacts, from joints
/// that hold a body to the world, and from the broadphase's boxes. `broadphase` is the world's (asserted).
/// Velocities, sleep, contacts and pairs stay. Shift yourself what the program keeps: bodies that are in no
/// world, zones, cameras, terrains. Every motion state is asked for its place and told the new one, whether
/// its body moves or not. Returns whether the world was shifted; if not, nothing has changed. Cost: a look at
/// each object, contact and joint, and SpatialHashBroadphase::shiftOrigin().
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btDynamicsWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);
/// The same for any world.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btCollisionWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

[[nodiscard]] bool shiftWorldWithoutJoints(btCollisionWorld& world,
                                           SpatialHashBroadphase& broadphase,
                                           const btVector3& shift);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
