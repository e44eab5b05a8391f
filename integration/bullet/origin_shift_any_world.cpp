// SPDX-License-Identifier: Zlib

// Of a world of which the program does not say whether it has joints. Apart from the rest: a Bullet that was
// compiled without RTTI does not link with this.

#include <integration/bullet/origin_shift.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/diagnostics.hpp>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

template <class World>
World* worldAs([[maybe_unused]] btCollisionWorld& world) {
#if HASHPHASE_HAS_RTTI
    if (detail::knowsItsType(world)) {
        return dynamic_cast<World*>(&world);
    }
#endif
    return nullptr;
}

bool mayHaveJoints(btCollisionWorld& world) {
    if (detail::knowsItsType(world)) {
        return false;
    }
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        if (btRigidBody::upcast(objects[i]) != nullptr) {
            return true;
        }
    }
    return false;
}

}  // namespace

bool shiftWorldOrigin(btCollisionWorld& world, SpatialHashBroadphase& broadphase,
                      const btVector3& shift) {
    if (auto* const ofMultiBodies = worldAs<btMultiBodyDynamicsWorld>(world)) {
        return shiftWorldOrigin(*ofMultiBodies, broadphase, shift);
    }
    if (auto* const dynamics = worldAs<btDynamicsWorld>(world)) {
        return shiftWorldOrigin(*dynamics, broadphase, shift);
    }
    const bool isKnown = !mayHaveJoints(world);
    HASHPHASE_ASSERT(isKnown,
                     "shiftWorldOrigin(): the world has bodies, and its type is unknown without "
                     "RTTI. Pass it as a btDynamicsWorld.");
    return isKnown && detail::shiftWorldWithoutJoints(world, broadphase, shift);
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
