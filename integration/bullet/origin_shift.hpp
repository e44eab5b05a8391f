// SPDX-License-Identifier: Zlib
#pragma once

// Moves the origin of a whole Bullet world. Far from the origin numbers are coarse: bodies jitter and
// joints drift. A world that is followed by its player is kept near by shifting the origin now and
// then; nothing falls apart, wakes up, or loses its contacts.
//
// A frame   between two steps
// Choose    shifts by multiples of a power of two, such as 1024 m, towards where the bodies are: they
//           round nothing there, and leave all that is relative as it was, to the bit.
// Threads   needs the world for itself.
// Memory    Where it runs out, std::bad_alloc is passed on, and nothing is shifted.
// Misuse    Soft bodies and multibodies keep coordinates of their own, which are not known here: a
//           world that has any is not shifted, nor by what is not finite. Asserted, and returned.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Moves the world's origin to `shift` [m]: subtracts it from the place of every collision object and
/// its interpolation, from the motion states of bodies, from the points of all contacts, from joints
/// that hold a body to the world, and from the broadphase's boxes, in one call. `broadphase` is the
/// world's (asserted). Velocities, sleep, contacts and pairs stay. What the program keeps itself is
/// its own to shift: bodies that are in no world, zones, cameras, terrains. A motion state is asked for
/// its place and told the new one, whether its body moves or not. Cost: a look at each object,
/// contact and joint, and SpatialHashBroadphase::shiftOrigin(). Returns whether the world was shifted;
/// if not, nothing has changed.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool shiftWorldOrigin(btCollisionWorld& world,
                                                            SpatialHashBroadphase& broadphase,
                                                            const btVector3& shift);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
