// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/body_motion.hpp>

#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <limits>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

Aabb<btScalar> boxAt(const btCollisionObject& object, const btTransform& transform) {
    btVector3 low;
    btVector3 high;
    object.getCollisionShape()->getAabb(transform, low, high);
    const btVector3 margin(gContactBreakingThreshold, gContactBreakingThreshold,
                           gContactBreakingThreshold);
    return toAabb(low - margin, high + margin);
}

}  // namespace

std::optional<BodyMotion> fastMotion(const btBroadphaseProxy& proxy, btScalar share) {
    const auto* object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
    if (object == nullptr || object->getInternalType() != btCollisionObject::CO_RIGID_BODY ||
        object->isStaticOrKinematicObject()) {
        return std::nullopt;
    }
    const btTransform& start = object->getWorldTransform();
    const btTransform& end = object->getInterpolationWorldTransform();
    const Vector3<btScalar> way = toEigen(end.getOrigin() - start.getOrigin());
    if (way.isZero(0) || !way.allFinite()) {
        return std::nullopt;
    }
    const Aabb<btScalar> first = boxAt(*object, start);
    if (!(way.norm() > share * first.sizes().minCoeff())) {
        return std::nullopt;
    }
    // Where the box of the end was at the start, had it only moved.
    const Aabb<btScalar> last = boxAt(*object, end);
    const Vector3<btScalar> rounding =
        (last.min().cwiseAbs() + last.max().cwiseAbs() + way.cwiseAbs()) *
        (2 * std::numeric_limits<btScalar>::epsilon());
    MovingBox<btScalar> moving{first, way};
    moving.box.extend(last.min() - way - rounding);
    moving.box.extend(last.max() - way + rounding);
    return BodyMotion{moving, first.merged(last)};
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
