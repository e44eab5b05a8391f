// SPDX-License-Identifier: Zlib
#include <integration/bullet/shape_pick.hpp>

#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// Keeps the nearest hit among the objects that the filter accepts.
struct ClosestOf final : btCollisionWorld::RayResultCallback {
    explicit ClosestOf(ProxyFilter filter) : filter_(filter) {}

    bool needsCollision(btBroadphaseProxy* proxy) const override {
        castAt_ = SpatialHashBroadphase::idOf(proxy);
        return filter_(castAt_);
    }
    btScalar addSingleResult(btCollisionWorld::LocalRayResult& result,
                             bool /*normalInWorldSpace*/) override {
        m_collisionObject = result.m_collisionObject;
        m_closestHitFraction = result.m_hitFraction;
        id_ = castAt_;
        return m_closestHitFraction;
    }

    /// Of the object that was hit: the object itself may know another proxy, or none.
    [[nodiscard]] ProxyId id() const noexcept { return id_; }

private:
    ProxyFilter filter_;
    mutable ProxyId castAt_;  // was asked about last, and so is cast at next
    ProxyId id_;
};

btVector3 endOf(const RayRegion<btScalar>& ray) {
    return toBullet(ray.from() + ray.direction());
}

}  // namespace

std::optional<btScalar> ShapeTest::operator()(ProxyId id, const RayRegion<btScalar>& ray,
                                              btScalar limit) const {
    ClosestOf closest(acceptAll);
    closest.m_closestHitFraction = std::min(limit, btScalar(1));
    castAtShape(*broadphase_, id, toBullet(ray.from()), endOf(ray), closest);
    if (!closest.hasHit()) {
        return std::nullopt;
    }
    // Bullet ends a cast at about 1 cm from a shape, and so perhaps in front of the shape's box.
    return std::max(closest.m_closestHitFraction, ray.key(broadphase_->grid().box(id)));
}

KeyedProxy<btScalar> closestShape(const SpatialHashBroadphase& broadphase,
                                  const RayRegion<btScalar>& ray, ProxyFilter filter) {
    ClosestOf closest(filter);
    if (!ray.isEmpty() && !ray.direction().isZero(0)) {
        broadphase.closestRay(toBullet(ray.from()), endOf(ray), closest);
    }
    if (!closest.hasHit()) {
        return {};
    }
    return {closest.m_closestHitFraction, closest.id()};
}

void castAtShape(const SpatialHashBroadphase& broadphase, ProxyId id, const btVector3& from,
                 const btVector3& to, btCollisionWorld::RayResultCallback& callback) {
    btBroadphaseProxy* proxy = broadphase.proxyOf(id);
    auto* object = static_cast<btCollisionObject*>(proxy->m_clientObject);
    if (object != nullptr && callback.needsCollision(proxy)) {
        btCollisionWorld::rayTestSingle(btTransform(btMatrix3x3::getIdentity(), from),
                                        btTransform(btMatrix3x3::getIdentity(), to), object,
                                        object->getCollisionShape(), object->getWorldTransform(),
                                        callback);
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
