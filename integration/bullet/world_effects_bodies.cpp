// SPDX-License-Identifier: Zlib

// What WorldConfigurator sets on single objects.

#include <integration/bullet/world_effects.hpp>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

constexpr int kGyroscopicFlags = BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                                 BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;

// Of half the smallest edge: the sphere that Bullet sweeps keeps clear of what the body slides along.
constexpr auto kSweptShare = btScalar(0.5);

/// `value` where it is to be overridden.
template <class Value>
std::optional<Value> overridden(bool isOverridden, const Value& value) {
    return isOverridden ? std::optional<Value>(value) : std::nullopt;
}

/// Writes what `kept` says, if that is anything new; returns whether it was.
template <class Value, class Write>
bool set(detail::KeptSetting<Value>& kept, const Value& present, const std::optional<Value>& wanted,
         const Write& write) {
    const Value next = kept.next(present, wanted);
    if (next == present) {
        return false;
    }
    write(next);
    return true;
}

bool solvesContactsOfItsOwn(const btCollisionObject& object) {
    constexpr int kinds = btCollisionObject::CO_SOFT_BODY | btCollisionObject::CO_HF_FLUID |
                          btCollisionObject::CO_FEATHERSTONE_LINK;
    return (object.getInternalType() & kinds) != 0;
}

bool areAllItsOwn(const BodyEffects& effects, const WorldEffects& ofWorld) {
    return effects.response && effects.sweep && effects.sleeping && effects.rotation &&
           effects.friction && !ofWorld.restitution && !ofWorld.fastFrom && !ofWorld.slowBelow;
}

btScalar smallestEdge(const btCollisionShape& shape) {
    btVector3 low;
    btVector3 high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    const btVector3 edges = high - low;
    return edges[edges.minAxis()];
}

}  // namespace

bool WorldConfigurator::KeptBody::isHeld() const noexcept {
    return noResponse.isHeld() || friction.isHeld() || rollingFriction.isHeld() ||
           spinningFriction.isHeld() || restitution.isHeld() || angularFactor.isHeld() ||
           gyroscopicFlags.isHeld() || ccdThreshold.isHeld() || ccdRadius.isHeld() ||
           slowBelow.isHeld() || isKeptAwake;
}

// Whether the object may be the one of which this is kept: some of what was set is to be seen, though
// its owner may have set the rest. What Bullet sets by itself tells nothing: neither rolling friction nor
// a motion to sweep from.
bool WorldConfigurator::KeptBody::mayBeOf(const btCollisionObject& object) const {
    const btRigidBody* const body = btRigidBody::upcast(&object);
    const bool isAnythingSet = noResponse.isHeld() || friction.isHeld() || restitution.isHeld() ||
                               angularFactor.isHeld() || slowBelow.isHeld() || isKeptAwake;
    return !isAnythingSet ||
           noResponse.isAsWritten(object.getCollisionFlags() &
                                  btCollisionObject::CF_NO_CONTACT_RESPONSE) ||
           friction.isAsWritten(object.getFriction()) ||
           restitution.isAsWritten(object.getRestitution()) ||
           (isKeptAwake && object.getActivationState() == DISABLE_DEACTIVATION) ||
           (body != nullptr && (angularFactor.isAsWritten(body->getAngularFactor()) ||
                                slowBelow.isAsWritten(body->getLinearSleepingThreshold())));
}

// What is kept of the object; where nothing is, it is made if that is wanted, before anything is written.
WorldConfigurator::KeptBody* WorldConfigurator::keptOf(const btCollisionObject& object,
                                                       bool isWanted) {
    auto found = kept_.find(&object);
    if (found != kept_.end() && found->second.wasAway && !found->second.mayBeOf(object)) {
        kept_.erase(found);  // that was another one
        found = kept_.end();
    }
    if (found == kept_.end() && isWanted) {
        found = kept_.try_emplace(&object).first;
    }
    return found == kept_.end() ? nullptr : &found->second;
}

bool WorldConfigurator::configure(btCollisionObject& object, const BodyEffects& effects,
                                  const WorldEffects& ofWorld) {
    if (solvesContactsOfItsOwn(object)) {
        return false;
    }
    KeptBody* const found = keptOf(object, !areAllItsOwn(effects, ofWorld));
    if (found == nullptr) {
        return false;
    }
    KeptBody& kept = *found;
    kept.wasAway = false;
    kept.lastSeen = applyCount_;
    bool isChanged = setContacts(object, kept, effects, ofWorld);
    if (btRigidBody* const body = btRigidBody::upcast(&object)) {
        const bool isTurned =
            setRotation(*body, kept, !effects.rotation && !body->isStaticOrKinematicObject());
        isChanged = isChanged || isTurned;
        setSweep(*body, kept, effects, ofWorld);
        setSleeping(*body, kept, effects, ofWorld);
    }
    if (!kept.isHeld()) {
        kept_.erase(&object);
    }
    return isChanged;
}

bool WorldConfigurator::setContacts(btCollisionObject& object, KeptBody& kept,
                                    const BodyEffects& effects, const WorldEffects& ofWorld) {
    constexpr int flag = btCollisionObject::CF_NO_CONTACT_RESPONSE;
    const int flags = object.getCollisionFlags();
    const std::optional<btScalar> noFriction = overridden(!effects.friction, btScalar(0));
    std::optional<btScalar> restitution;
    if (ofWorld.restitution) {
        restitution = std::sqrt(*ofWorld.restitution);  // Bullet multiplies those of both
    }
    bool isChanged = set(kept.noResponse, flags & flag, overridden(!effects.response, flag),
                         [&](int next) { object.setCollisionFlags((flags & ~flag) | next); });
    isChanged |= set(kept.friction, object.getFriction(), noFriction,
                     [&](btScalar next) { object.setFriction(next); });
    isChanged |= set(kept.rollingFriction, object.getRollingFriction(), noFriction,
                     [&](btScalar next) { object.setRollingFriction(next); });
    isChanged |= set(kept.spinningFriction, object.getSpinningFriction(), noFriction,
                     [&](btScalar next) { object.setSpinningFriction(next); });
    isChanged |= set(kept.restitution, object.getRestitution(), restitution,
                     [&](btScalar next) { object.setRestitution(next); });
    return isChanged;
}

bool WorldConfigurator::setRotation(btRigidBody& body, KeptBody& kept, bool isWithout) {
    const int flags = body.getFlags();
    set(kept.gyroscopicFlags, flags & kGyroscopicFlags, overridden(isWithout, 0),
        [&](int next) { body.setFlags((flags & ~kGyroscopicFlags) | next); });
    if (isWithout) {
        body.setAngularVelocity(btVector3(0, 0, 0));
        body.setInterpolationAngularVelocity(btVector3(0, 0, 0));
    }
    return set(kept.angularFactor, body.getAngularFactor(),
               overridden(isWithout, btVector3(0, 0, 0)),
               [&](const btVector3& next) { body.setAngularFactor(next); });
}

// Bullet looks itself, in each step, who moves by more than the threshold.
void WorldConfigurator::setSweep(btRigidBody& body, KeptBody& kept, const BodyEffects& effects,
                                 const WorldEffects& ofWorld) {
    std::optional<btScalar> threshold;
    std::optional<btScalar> radius;
    if (!effects.sweep) {
        threshold = btScalar(0);
    } else if (ofWorld.fastFrom && !body.isStaticOrKinematicObject() &&
               body.getCollisionShape()->isConvex()) {
        const btScalar edge = smallestEdge(*body.getCollisionShape());
        threshold = std::max(*ofWorld.fastFrom * edge, SIMD_EPSILON);  // 0 would mean never
        radius = kSweptShare * edge / 2;
    }
    set(kept.ccdThreshold, body.getCcdMotionThreshold(), threshold,
        [&](btScalar next) { body.setCcdMotionThreshold(next); });
    set(kept.ccdRadius, body.getCcdSweptSphereRadius(), radius,
        [&](btScalar next) { body.setCcdSweptSphereRadius(next); });
}

void WorldConfigurator::setSleeping(btRigidBody& body, KeptBody& kept, const BodyEffects& effects,
                                    const WorldEffects& ofWorld) {
    set(kept.slowBelow, body.getLinearSleepingThreshold(), ofWorld.slowBelow, [&](btScalar next) {
        body.setSleepingThresholds(next, body.getAngularSleepingThreshold());
    });
    const int state = body.getActivationState();
    const bool isWithout = !effects.sleeping && !body.isStaticOrKinematicObject();
    if (isWithout && state != DISABLE_DEACTIVATION && state != DISABLE_SIMULATION) {
        body.forceActivationState(DISABLE_DEACTIVATION);
        kept.isKeptAwake = true;
    } else if (!isWithout && kept.isKeptAwake) {
        if (state == DISABLE_DEACTIVATION) {
            body.forceActivationState(ACTIVE_TAG);
            body.setDeactivationTime(0);
        }
        kept.isKeptAwake = false;
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
