// SPDX-License-Identifier: Zlib
#include <integration/bullet/world_cost.hpp>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

void countContacts(btDispatcher& dispatcher, WorldCost& cost) {
    cost.manifoldCount = dispatcher.getNumManifolds();
    for (int i = 0; i < cost.manifoldCount; ++i) {
        const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
        cost.contactCount += manifold.getNumContacts();
        if (!dispatcher.needsResponse(manifold.getBody0(), manifold.getBody1())) {
            continue;
        }
        cost.answeredContactCount += manifold.getNumContacts();
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            cost.rubbingContactCount += manifold.getContactPoint(k).m_combinedFriction > 0;
        }
    }
}

void countBody(const btRigidBody& body, const btDispatcherInfo& info, WorldCost& cost) {
    if (body.isStaticOrKinematicObject()) {
        return;
    }
    cost.turningCount += !body.getAngularVelocity().isZero();
    if (!body.isActive()) {
        cost.sleepingCount += body.getActivationState() == ISLAND_SLEEPING;
        return;
    }
    ++cost.awakeCount;
    cost.sweptCount +=
        info.m_useContinuous && isSwept(body, body.getLinearVelocity().length() * info.m_timeStep);
}

}  // namespace

bool isSwept(const btRigidBody& body, btScalar way) {
    const btScalar threshold = body.getCcdMotionThreshold();
    return threshold != 0 && way * way > threshold * threshold && body.isActive() &&
           !body.isStaticOrKinematicObject() && body.getCollisionShape()->isConvex();
}

WorldCost costOf(btDiscreteDynamicsWorld& world) {
    WorldCost cost;
    cost.pairCount = world.getPairCache()->getNumOverlappingPairs();
    countContacts(*world.getDispatcher(), cost);
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        if (const btRigidBody* const body = btRigidBody::upcast(objects[i])) {
            countBody(*body, world.getDispatchInfo(), cost);
        }
    }
    return cost;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
