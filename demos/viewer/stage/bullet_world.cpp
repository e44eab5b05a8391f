// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_world.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cmath>
#include <utility>

namespace hashphase::demos {

// --- Bodies --------------------------------------------------------------------------------------

namespace {

void takeShape(const btCollisionShape& shape, StageBody& body) {
    switch (shape.getShapeType()) {
        case SPHERE_SHAPE_PROXYTYPE:
            body.shape = StageBody::Shape::sphere;
            body.size.setConstant(static_cast<const btSphereShape&>(shape).getRadius());
            return;
        case CAPSULE_SHAPE_PROXYTYPE: {
            const auto& capsule = static_cast<const btCapsuleShape&>(shape);
            body.shape = StageBody::Shape::capsule;
            body.size = {capsule.getRadius(), capsule.getHalfHeight(), 0};
            // Drawn upright, along y.
            const int axis = capsule.getUpAxis();
            if (axis != 1) {
                const float half = std::sqrt(0.5F);
                body.orientation =
                    body.orientation * (axis == 0 ? Eigen::Quaternionf(half, 0, 0, -half)
                                                  : Eigen::Quaternionf(half, half, 0, 0));
            }
            return;
        }
        case BOX_SHAPE_PROXYTYPE:
            body.shape = StageBody::Shape::box;
            body.size = toEigen(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
            return;
        default: {
            btVector3 low;
            btVector3 high;
            shape.getAabb(btTransform::getIdentity(), low, high);
            body.shape = StageBody::Shape::box;
            body.size = toEigen((high - low) / 2);
        }
    }
}

}  // namespace

bool isGround(const btRigidBody& body) {
    const btCollisionShape& shape = *body.getCollisionShape();
    if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
        return true;
    }
    return body.getUserIndex() == 0 && body.isStaticObject() &&
           shape.getShapeType() == BOX_SHAPE_PROXYTYPE;
}

StageBody stageBody(const btRigidBody& body) {
    const btTransform& place = body.getWorldTransform();
    const btQuaternion turn = place.getRotation();
    StageBody seen;
    seen.centre = toEigen(place.getOrigin());
    seen.orientation = Eigen::Quaternionf(turn.w(), turn.x(), turn.y(), turn.z());
    seen.speed = body.getLinearVelocity().length();
    seen.isStatic = body.isStaticObject();
    seen.isAsleep = !seen.isStatic && !body.isActive();
    takeShape(*body.getCollisionShape(), seen);
    return seen;
}

// --- The world -----------------------------------------------------------------------------------

BulletWorld::BulletWorld(const BroadphaseKind& kind, const WorldSceneKind& scene,
                         std::size_t objects, std::uint64_t seed)
    : broadphase(kind.make({.bounds = {}, .objects = objects})),
      world(&dispatcher, broadphase.get(), &solver, &configuration) {
    scene.fill(contents, objects, seed);
    configurator = std::make_unique<WorldConfigurator>(world);
    apply({});
}

std::vector<ProfileZone> BulletWorld::step() {
    return profileZonesOf([this] { configurator->step(kFrameSeconds); });
}

// Nobody moves what rests by hand.
void BulletWorld::apply(WorldEffects effects) {
    effects.restingBoxes = false;
    configurator->apply(effects);
}

std::optional<std::int64_t> BulletWorld::memoryBytes() const noexcept {
    const auto* ours = dynamic_cast<const SpatialHashBroadphase*>(broadphase.get());
    return ours != nullptr ? std::optional(static_cast<std::int64_t>(ours->memoryBytes()))
                           : world.heap().bytes();
}

void BulletWorld::remove(btRigidBody& body) {
    // The world would go on solving them.
    for (int i = world.getNumConstraints() - 1; i >= 0; --i) {
        btTypedConstraint& joint = *world.getConstraint(i);
        if (&joint.getRigidBodyA() == &body || &joint.getRigidBodyB() == &body) {
            joint.getRigidBodyA().activate();
            joint.getRigidBodyB().activate();
            world.removeConstraint(&joint);
        }
    }
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold& contact = *dispatcher.getManifoldByIndexInternal(i);
        if (contact.getBody0() == &body || contact.getBody1() == &body) {
            contact.getBody0()->activate();
            contact.getBody1()->activate();
        }
    }
    configurator->release(body);
    world.removeRigidBody(&body);
}

namespace {

/// As its present proxy; with another broadphase.
btBroadphaseProxy* proxyIn(btBroadphaseInterface& next, btRigidBody& body,
                           btDispatcher& dispatcher) {
    btVector3 low;
    btVector3 high;
    body.getAabb(low, high);
    const btBroadphaseProxy* present = body.getBroadphaseHandle();
    const CollisionFilter filter =
        present ? CollisionFilter{present->m_collisionFilterGroup, present->m_collisionFilterMask}
                : CollisionFilter{0, 0};
    return next.createProxy(low, high, body.getCollisionShape()->getShapeType(), &body,
                            filter.group, filter.mask, &dispatcher);
}

}  // namespace

// What the former broadphase gives back is not the next one's, so it ends after that was measured.
void BulletWorld::replaceBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs) {
    const WorldEffects effects = configurator->effects();
    configurator = nullptr;
    const auto bodies = contents.bodies();
    std::vector<btBroadphaseProxy*> proxies(bodies.size());
    std::unique_ptr<btBroadphaseInterface> next;
    HeapMeter used;
    {
        const HeapScope scope(used);
        next = kind.make(needs);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            proxies[i] = proxyIn(*next, *bodies[i], dispatcher);
        }
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (bodies[i]->getBroadphaseHandle() == nullptr) {
                next->destroyProxy(proxies[i], &dispatcher);
            }
        }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (btBroadphaseProxy* const before = bodies[i]->getBroadphaseHandle()) {
            broadphase->getOverlappingPairCache()->cleanProxyFromPairs(before, &dispatcher);
            broadphase->destroyProxy(before, &dispatcher);
            bodies[i]->setBroadphaseHandle(proxies[i]);
        }
    }
    world.setBroadphase(next.get());
    broadphase = std::move(next);
    world.heap() = used;
    configurator = std::make_unique<WorldConfigurator>(world);
    configurator->apply(effects);
}

}  // namespace hashphase::demos
