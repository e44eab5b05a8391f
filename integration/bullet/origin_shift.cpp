// SPDX-License-Identifier: Zlib
#include <integration/bullet/origin_shift.hpp>

#include <broadphase/diagnostics.hpp>
#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <LinearMath/btMotionState.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

btTransform shifted(const btTransform& place, const btVector3& shift) {
    return btTransform(place.getBasis(), place.getOrigin() - shift);
}

[[maybe_unused]] constexpr const char* kHasUnknownCoordinates =
    "shiftWorldOrigin(): the world has soft bodies or multibodies, which cannot be shifted. Remove "
    "them from the world first.";

bool hasOnlyKnownCoordinates(btCollisionWorld& world) {
    constexpr int unknown =
        btCollisionObject::CO_SOFT_BODY | btCollisionObject::CO_FEATHERSTONE_LINK;
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        if ((objects[i]->getInternalType() & unknown) != 0) {
            return false;
        }
    }
    return true;
}

bool canShift(btCollisionWorld& world, const SpatialHashBroadphase& broadphase,
              const btVector3& shift) {
    const bool isItsOwn = world.getBroadphase() == &broadphase;
    const bool isKnown = hasOnlyKnownCoordinates(world);
    const bool isFinite = toEigen(shift).allFinite();
    HASHPHASE_ASSERT(
        isItsOwn,
        "shiftWorldOrigin(): the world has another broadphase. Pass the broadphase of the world.");
    HASHPHASE_ASSERT(isKnown, kHasUnknownCoordinates);
    HASHPHASE_ASSERT(
        isFinite, "shiftWorldOrigin(): the shift is NaN or infinite. Pass finite coordinates [m].");
    return isItsOwn && isKnown && isFinite;
}

// Kinematic bodies are placed by their motion states in the next step; those of bodies asleep are told
// by nobody else.
void shiftMotionState(btRigidBody* body, const btTransform& unshifted, const btVector3& shift) {
    btMotionState* const state = body != nullptr ? body->getMotionState() : nullptr;
    if (state != nullptr) {
        btTransform place = unshifted;
        state->getWorldTransform(place);  // which may leave it as it is
        state->setWorldTransform(shifted(place, shift));
    }
}

void shiftObjects(btCollisionWorld& world, const btVector3& shift) {
    btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btCollisionObject& object = *objects[i];
        const btTransform place = object.getWorldTransform();
        object.setWorldTransform(shifted(place, shift));
        object.setInterpolationWorldTransform(
            shifted(object.getInterpolationWorldTransform(), shift));
        shiftMotionState(btRigidBody::upcast(&object), place, shift);
    }
}

void shiftContacts(btDispatcher* dispatcher, const btVector3& shift) {
    for (int i = 0; dispatcher != nullptr && i < dispatcher->getNumManifolds(); ++i) {
        btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(i);
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            btManifoldPoint& point = manifold.getContactPoint(k);
            point.m_positionWorldOnA -= shift;
            point.m_positionWorldOnB -= shift;
        }
    }
}

template <class Joint>
void shiftFrames(btTypedConstraint& constraint, bool ofA, const btVector3& shift) {
    auto& joint = static_cast<Joint&>(constraint);
    (ofA ? joint.getFrameOffsetA() : joint.getFrameOffsetB()).getOrigin() -= shift;
}

// A joint of one body has the world as its other one, a body that stays at the origin: its frame
// there has the coordinates of the world.
void shiftJoint(btTypedConstraint& joint, const btVector3& shift) {
    const btRigidBody* const theWorld = &btTypedConstraint::getFixedBody();
    const bool ofA = &joint.getRigidBodyA() == theWorld;
    if (!ofA && &joint.getRigidBodyB() != theWorld) {
        return;
    }
    switch (joint.getConstraintType()) {
        case POINT2POINT_CONSTRAINT_TYPE: {
            auto& point = static_cast<btPoint2PointConstraint&>(joint);
            ofA ? point.setPivotA(point.getPivotInA() - shift)
                : point.setPivotB(point.getPivotInB() - shift);
            break;
        }
        case CONETWIST_CONSTRAINT_TYPE: {
            auto& cone = static_cast<btConeTwistConstraint&>(joint);
            cone.setFrames(ofA ? shifted(cone.getAFrame(), shift) : cone.getAFrame(),
                           ofA ? cone.getBFrame() : shifted(cone.getBFrame(), shift));
            break;
        }
        case HINGE_CONSTRAINT_TYPE:
            shiftFrames<btHingeConstraint>(joint, ofA, shift);
            break;
        case SLIDER_CONSTRAINT_TYPE:
            shiftFrames<btSliderConstraint>(joint, ofA, shift);
            break;
        case D6_CONSTRAINT_TYPE:
        case D6_SPRING_CONSTRAINT_TYPE:
            shiftFrames<btGeneric6DofConstraint>(joint, ofA, shift);
            break;
        case D6_SPRING_2_CONSTRAINT_TYPE:
            shiftFrames<btGeneric6DofSpring2Constraint>(joint, ofA, shift);
            break;
        default:  // axes only
            break;
    }
}

}  // namespace

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

bool shiftWorldWithoutJoints(btCollisionWorld& world, SpatialHashBroadphase& broadphase,
                             const btVector3& shift) {
    if (!canShift(world, broadphase, shift)) {
        return false;
    }
    broadphase.shiftOrigin(shift);  // first: nothing else takes memory
    shiftObjects(world, shift);
    shiftContacts(world.getDispatcher(), shift);
    return true;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

bool shiftWorldOrigin(btDynamicsWorld& world, SpatialHashBroadphase& broadphase,
                      const btVector3& shift) {
    if (!detail::shiftWorldWithoutJoints(world, broadphase, shift)) {
        return false;
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        shiftJoint(*world.getConstraint(i), shift);
    }
    return true;
}

// By its type: dynamic_cast would not link with a Bullet that was compiled without RTTI.
bool shiftWorldOrigin(btMultiBodyDynamicsWorld& world, SpatialHashBroadphase& broadphase,
                      const btVector3& shift) {
    const bool isKnown = world.getNumMultibodies() == 0;
    HASHPHASE_ASSERT(isKnown, kHasUnknownCoordinates);
    return isKnown && shiftWorldOrigin(static_cast<btDynamicsWorld&>(world), broadphase, shift);
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
