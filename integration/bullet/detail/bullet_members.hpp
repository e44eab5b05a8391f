// SPDX-License-Identifier: Zlib
#pragma once

// What of Bullet's objects a step depends on, member by member: one list a class, for both ways, to bytes and
// back. Not listed are pointers, and what a step writes before it reads it.
//
// Some of these are private. An explicit instantiation may name private members (C++ standard, [temp.explicit]);
// that of Reveal makes each of them known to a function that is found by its tag. Where a version of Bullet
// renames one, this does not compile.

#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

template <class Tag, typename Tag::Member kMember>
struct Reveal {
    friend constexpr typename Tag::Member revealed(Tag /*tag*/) { return kMember; }
};

template <class Class, class Type>
using MemberOf = Type Class::*;

#define HASHPHASE_REVEAL(Class, Type, name)                                                        \
    struct Class##_##name {                                                                        \
        using Member = MemberOf<Class, Type>;                                                      \
        friend constexpr Member revealed(Class##_##name /*tag*/);                                  \
    };                                                                                             \
    template struct Reveal<Class##_##name, &Class::name>

HASHPHASE_REVEAL(btRigidBody, btMatrix3x3, m_invInertiaTensorWorld);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_linearVelocity);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_angularVelocity);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_inverseMass);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_linearFactor);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_gravity);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_gravity_acceleration);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_invInertiaLocal);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_totalForce);
HASHPHASE_REVEAL(btRigidBody, btVector3, m_totalTorque);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_linearDamping);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_angularDamping);
HASHPHASE_REVEAL(btRigidBody, bool, m_additionalDamping);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_additionalDampingFactor);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_additionalLinearDampingThresholdSqr);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_additionalAngularDampingThresholdSqr);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_additionalAngularDampingFactor);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_linearSleepingThreshold);
HASHPHASE_REVEAL(btRigidBody, btScalar, m_angularSleepingThreshold);
HASHPHASE_REVEAL(btRigidBody, btAlignedObjectArray<btTypedConstraint*>, m_constraintRefs);
HASHPHASE_REVEAL(btRigidBody, int, m_rigidbodyFlags);
HASHPHASE_REVEAL(btCompoundCompoundCollisionAlgorithm, btHashedSimplePairCache*,
                 m_childCollisionAlgorithmCache);
HASHPHASE_REVEAL(btCompoundCompoundCollisionAlgorithm, int, m_compoundShapeRevision0);
HASHPHASE_REVEAL(btCompoundCompoundCollisionAlgorithm, int, m_compoundShapeRevision1);

#undef HASHPHASE_REVEAL

// What is protected, a class that derives from it may name.

struct ObjectMembers : btCollisionObject {
    template <class Visit>
    static void forEach(btCollisionObject& object, const Visit& visit) {
        visit(object.*(&ObjectMembers::m_worldTransform));
        visit(object.*(&ObjectMembers::m_interpolationWorldTransform));
        visit(object.*(&ObjectMembers::m_interpolationLinearVelocity));
        visit(object.*(&ObjectMembers::m_interpolationAngularVelocity));
        visit(object.*(&ObjectMembers::m_anisotropicFriction));
        visit(object.*(&ObjectMembers::m_hasAnisotropicFriction));
        visit(object.*(&ObjectMembers::m_contactProcessingThreshold));
        visit(object.*(&ObjectMembers::m_collisionFlags));
        visit(object.*(&ObjectMembers::m_islandTag1));
        visit(object.*(&ObjectMembers::m_activationState1));
        visit(object.*(&ObjectMembers::m_deactivationTime));
        visit(object.*(&ObjectMembers::m_friction));
        visit(object.*(&ObjectMembers::m_restitution));
        visit(object.*(&ObjectMembers::m_rollingFriction));
        visit(object.*(&ObjectMembers::m_spinningFriction));
        visit(object.*(&ObjectMembers::m_contactDamping));
        visit(object.*(&ObjectMembers::m_contactStiffness));
        visit(object.*(&ObjectMembers::m_hitFraction));
        visit(object.*(&ObjectMembers::m_ccdSweptSphereRadius));
        visit(object.*(&ObjectMembers::m_ccdMotionThreshold));
        visit(object.*(&ObjectMembers::m_checkCollideWith));
        visit(object.*(&ObjectMembers::m_updateRevision));
    }
    static btCollisionShape*& shape(btCollisionObject& object) {
        return object.*(&ObjectMembers::m_collisionShape);
    }
    static btCollisionShape*& rootShape(btCollisionObject& object) {
        return object.*(&ObjectMembers::m_rootCollisionShape);
    }
    static int& activationState(btCollisionObject& object) {
        return object.*(&ObjectMembers::m_activationState1);
    }
    static int& checksCollisions(btCollisionObject& object) {
        return object.*(&ObjectMembers::m_checkCollideWith);
    }
    static btAlignedObjectArray<const btCollisionObject*>& ignored(btCollisionObject& object) {
        return object.*(&ObjectMembers::m_objectsWithoutCollisionCheck);
    }
};

struct BodyMembers : btRigidBody {
    template <class Visit>
    static void forEach(btRigidBody& body, const Visit& visit) {
        visit(body.*revealed(btRigidBody_m_invInertiaTensorWorld()));
        visit(body.*revealed(btRigidBody_m_linearVelocity()));
        visit(body.*revealed(btRigidBody_m_angularVelocity()));
        visit(body.*revealed(btRigidBody_m_inverseMass()));
        visit(body.*revealed(btRigidBody_m_linearFactor()));
        visit(body.*revealed(btRigidBody_m_gravity()));
        visit(body.*revealed(btRigidBody_m_gravity_acceleration()));
        visit(body.*revealed(btRigidBody_m_invInertiaLocal()));
        visit(body.*revealed(btRigidBody_m_totalForce()));
        visit(body.*revealed(btRigidBody_m_totalTorque()));
        visit(body.*revealed(btRigidBody_m_linearDamping()));
        visit(body.*revealed(btRigidBody_m_angularDamping()));
        visit(body.*revealed(btRigidBody_m_additionalDamping()));
        visit(body.*revealed(btRigidBody_m_additionalDampingFactor()));
        visit(body.*revealed(btRigidBody_m_additionalLinearDampingThresholdSqr()));
        visit(body.*revealed(btRigidBody_m_additionalAngularDampingThresholdSqr()));
        visit(body.*revealed(btRigidBody_m_additionalAngularDampingFactor()));
        visit(body.*revealed(btRigidBody_m_linearSleepingThreshold()));
        visit(body.*revealed(btRigidBody_m_angularSleepingThreshold()));
        visit(body.*revealed(btRigidBody_m_rigidbodyFlags()));
        visit(body.*(&BodyMembers::m_angularFactor));
        visit(body.*(&BodyMembers::m_invMass));
    }
    static btAlignedObjectArray<btTypedConstraint*>& joints(btRigidBody& body) {
        return body.*revealed(btRigidBody_m_constraintRefs());
    }
};

struct GhostMembers : btGhostObject {
    static btAlignedObjectArray<btCollisionObject*>& overlapping(btGhostObject& ghost) {
        return ghost.*(&GhostMembers::m_overlappingObjects);
    }
};

struct CharacterMembers : btKinematicCharacterController {
    template <class Visit>
    static void forEach(btKinematicCharacterController& character, const Visit& visit) {
        visit(character.*(&CharacterMembers::m_halfHeight));
        visit(character.*(&CharacterMembers::m_maxPenetrationDepth));
        visit(character.*(&CharacterMembers::m_verticalVelocity));
        visit(character.*(&CharacterMembers::m_verticalOffset));
        visit(character.*(&CharacterMembers::m_fallSpeed));
        visit(character.*(&CharacterMembers::m_jumpSpeed));
        visit(character.*(&CharacterMembers::m_SetjumpSpeed));
        visit(character.*(&CharacterMembers::m_maxJumpHeight));
        visit(character.*(&CharacterMembers::m_maxSlopeRadians));
        visit(character.*(&CharacterMembers::m_maxSlopeCosine));
        visit(character.*(&CharacterMembers::m_gravity));
        visit(character.*(&CharacterMembers::m_turnAngle));
        visit(character.*(&CharacterMembers::m_stepHeight));
        visit(character.*(&CharacterMembers::m_addedMargin));
        visit(character.*(&CharacterMembers::m_walkDirection));
        visit(character.*(&CharacterMembers::m_normalizedDirection));
        visit(character.*(&CharacterMembers::m_AngVel));
        visit(character.*(&CharacterMembers::m_jumpPosition));
        visit(character.*(&CharacterMembers::m_currentPosition));
        visit(character.*(&CharacterMembers::m_currentStepOffset));
        visit(character.*(&CharacterMembers::m_targetPosition));
        visit(character.*(&CharacterMembers::m_currentOrientation));
        visit(character.*(&CharacterMembers::m_targetOrientation));
        visit(character.*(&CharacterMembers::m_touchingContact));
        visit(character.*(&CharacterMembers::m_touchingNormal));
        visit(character.*(&CharacterMembers::m_linearDamping));
        visit(character.*(&CharacterMembers::m_angularDamping));
        visit(character.*(&CharacterMembers::m_wasOnGround));
        visit(character.*(&CharacterMembers::m_wasJumping));
        visit(character.*(&CharacterMembers::m_useGhostObjectSweepTest));
        visit(character.*(&CharacterMembers::m_useWalkDirection));
        visit(character.*(&CharacterMembers::m_velocityTimeInterval));
        visit(character.*(&CharacterMembers::m_up));
        visit(character.*(&CharacterMembers::m_jumpAxis));
        visit(character.*(&CharacterMembers::m_interpolateUp));
        visit(character.*(&CharacterMembers::full_drop));
        visit(character.*(&CharacterMembers::bounce_fix));
    }
};

struct CompoundMembers : btCompoundCollisionAlgorithm {
    static btAlignedObjectArray<btCollisionAlgorithm*>& children(
        btCompoundCollisionAlgorithm& algorithm) {
        return algorithm.*(&CompoundMembers::m_childCollisionAlgorithms);
    }
    static int& revision(btCompoundCollisionAlgorithm& algorithm) {
        return algorithm.*(&CompoundMembers::m_compoundShapeRevision);
    }
    /// Of one between two compounds.
    static btHashedSimplePairCache& childPairs(btCollisionAlgorithm& algorithm) {
        return *(static_cast<btCompoundCompoundCollisionAlgorithm&>(algorithm).*
                 revealed(btCompoundCompoundCollisionAlgorithm_m_childCollisionAlgorithmCache()));
    }
};

struct PairCacheMembers : btHashedOverlappingPairCache {
    /// As it was made, with its memory: nobody is told, and algorithms are not freed.
    static void clear(btHashedOverlappingPairCache& cache) {
        cache.getOverlappingPairArray().resizeNoInitialize(0);
        for (auto* const list :
             {&(cache.*(&PairCacheMembers::m_hashTable)), &(cache.*(&PairCacheMembers::m_next))}) {
            for (int i = 0; i < list->size(); ++i) {
                (*list)[i] = BT_NULL_PAIR;
            }
        }
    }
};

struct WorldMembers : btDiscreteDynamicsWorld {
    template <class Visit>
    static void forEach(btDiscreteDynamicsWorld& world, const Visit& visit) {
        visit(world.*(&WorldMembers::m_gravity));
        visit(world.*(&WorldMembers::m_localTime));
        visit(world.*(&WorldMembers::m_fixedTimeStep));
    }
    template <class Visit>
    static void forEachSetting(btDiscreteDynamicsWorld& world, const Visit& visit) {
        visit(world.*(&WorldMembers::m_synchronizeAllMotionStates));
        visit(world.*(&WorldMembers::m_applySpeculativeContactRestitution));
        visit(world.*(&WorldMembers::m_latencyMotionStateInterpolation));
        visit(world.*(&WorldMembers::m_forceUpdateAllAabbs));
    }
    static btAlignedObjectArray<btRigidBody*>& bodies(btDiscreteDynamicsWorld& world) {
        return world.*(&WorldMembers::m_nonStaticRigidBodies);
    }
    static btAlignedObjectArray<btTypedConstraint*>& joints(btDiscreteDynamicsWorld& world) {
        return world.*(&WorldMembers::m_constraints);
    }
    static btAlignedObjectArray<btActionInterface*>& actions(btDiscreteDynamicsWorld& world) {
        return world.*(&WorldMembers::m_actions);
    }
    static btAlignedObjectArray<btPersistentManifold*>& predicted(btDiscreteDynamicsWorld& world) {
        return world.*(&WorldMembers::m_predictiveManifolds);
    }
};

// --- All that is copied as it is -----------------------------------------------------------------

template <class Visit>
void forEachMember(btDiscreteDynamicsWorld& world, const Visit& visit) {
    WorldMembers::forEach(world, visit);
}

/// What a program sets of a world, but for the solver's.
struct WorldSettings {
    btDiscreteDynamicsWorld& world;
};

template <class Visit>
void forEachMember(const WorldSettings& settings, const Visit& visit) {
    WorldMembers::forEachSetting(settings.world, visit);
    btDispatcherInfo& dispatch = settings.world.getDispatchInfo();
    visit(dispatch.m_timeStep);
    visit(dispatch.m_stepCount);
    visit(dispatch.m_dispatchFunc);
    visit(dispatch.m_timeOfImpact);
    visit(dispatch.m_useContinuous);
    visit(dispatch.m_enableSatConvex);
    visit(dispatch.m_enableSPU);
    visit(dispatch.m_useEpa);
    visit(dispatch.m_allowedCcdPenetration);
    visit(dispatch.m_useConvexConservativeDistanceUtil);
    visit(dispatch.m_convexConservativeDistanceThreshold);
    visit(dispatch.m_deterministicOverlappingPairs);
}

template <class Visit>
void forEachMember(btCollisionObject& object, const Visit& visit) {
    ObjectMembers::forEach(object, visit);
    if (btRigidBody* const body = btRigidBody::upcast(&object)) {
        BodyMembers::forEach(*body, visit);
    }
}

template <class Visit>
void forEachMember(btKinematicCharacterController& character, const Visit& visit) {
    CharacterMembers::forEach(character, visit);
}

template <class Visit>
void forEachMember(btManifoldPoint& point, const Visit& visit) {
    visit(point.m_localPointA);
    visit(point.m_localPointB);
    visit(point.m_positionWorldOnB);
    visit(point.m_positionWorldOnA);
    visit(point.m_normalWorldOnB);
    visit(point.m_distance1);
    visit(point.m_combinedFriction);
    visit(point.m_combinedRollingFriction);
    visit(point.m_combinedSpinningFriction);
    visit(point.m_combinedRestitution);
    visit(point.m_partId0);
    visit(point.m_partId1);
    visit(point.m_index0);
    visit(point.m_index1);
    visit(point.m_contactPointFlags);
    visit(point.m_appliedImpulse);
    visit(point.m_prevRHS);
    visit(point.m_appliedImpulseLateral1);
    visit(point.m_appliedImpulseLateral2);
    visit(point.m_contactMotion1);
    visit(point.m_contactMotion2);
    visit(point.m_contactCFM);
    visit(point.m_contactERP);
    visit(point.m_frictionCFM);
    visit(point.m_lifeTime);
    visit(point.m_lateralFrictionDir1);
    visit(point.m_lateralFrictionDir2);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
