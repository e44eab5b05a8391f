// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_world.hpp>

#include <integration/bullet/conversions.hpp>

#include <algorithm>
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
    : dispatcher_(&configuration_),
      broadphase_(kind.make({.bounds = {}, .objects = objects})),
      world_(&dispatcher_, broadphase_.get(), &solver_, &configuration_),
      contents_(world_) {
    scene.fill(contents_, objects, seed);
    configurator_ = std::make_unique<WorldConfigurator>(world_);
    apply({});
}

// Nobody moves what rests by hand.
void BulletWorld::apply(WorldEffects effects) {
    effects.restingBoxes = false;
    configurator_->apply(effects);
}

std::uint64_t BulletWorld::memoryBytes() const noexcept {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(world_.heap().bytes().value_or(0), 0));
}

void BulletWorld::remove(btRigidBody& body) {
    // The world would go on solving them.
    for (int i = world_.getNumConstraints() - 1; i >= 0; --i) {
        btTypedConstraint& joint = *world_.getConstraint(i);
        if (&joint.getRigidBodyA() == &body || &joint.getRigidBodyB() == &body) {
            joint.getRigidBodyA().activate();
            joint.getRigidBodyB().activate();
            world_.removeConstraint(&joint);
        }
    }
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
        const btPersistentManifold& contact = *dispatcher_.getManifoldByIndexInternal(i);
        if (contact.getBody0() == &body || contact.getBody1() == &body) {
            contact.getBody0()->activate();
            contact.getBody1()->activate();
        }
    }
    configurator_->release(body);
    world_.removeRigidBody(&body);
}

void BulletWorld::replaceBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs) {
    const WorldEffects effects = configurator_->effects();
    configurator_ = nullptr;
    HeapMeter used;
    {
        const HeapScope scope(used);
        std::unique_ptr<btBroadphaseInterface> next = kind.make(needs);
        std::vector<btBroadphaseProxy*> removed;
        for (const auto& body : contents_.bodies()) {
            moveProxy(*body, *next, removed);
        }
        for (btBroadphaseProxy* proxy : removed) {
            next->destroyProxy(proxy, &dispatcher_);
        }
        world_.setBroadphase(next.get());
        broadphase_ = std::move(next);
    }
    world_.heap() = used;
    configurator_ = std::make_unique<WorldConfigurator>(world_);
    configurator_->apply(effects);
}

void BulletWorld::moveProxy(btRigidBody& body, btBroadphaseInterface& next,
                            std::vector<btBroadphaseProxy*>& removed) {
    btVector3 low;
    btVector3 high;
    body.getAabb(low, high);
    btBroadphaseProxy* before = body.getBroadphaseHandle();
    const CollisionFilter filter =
        before ? CollisionFilter{before->m_collisionFilterGroup, before->m_collisionFilterMask}
               : CollisionFilter{0, 0};
    btBroadphaseProxy* proxy = next.createProxy(low, high, body.getCollisionShape()->getShapeType(),
                                                &body, filter.group, filter.mask, &dispatcher_);
    if (before == nullptr) {
        removed.push_back(proxy);
        return;
    }
    broadphase_->getOverlappingPairCache()->cleanProxyFromPairs(before, &dispatcher_);
    broadphase_->destroyProxy(before, &dispatcher_);
    body.setBroadphaseHandle(proxy);
}

}  // namespace hashphase::demos
