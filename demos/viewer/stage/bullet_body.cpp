// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_body.hpp>

#include <integration/bullet/conversions.hpp>

namespace hashphase::demos {
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
                body.orientation =
                    body.orientation *
                    Eigen::Quaternionf::FromTwoVectors(Vector3<float>::UnitY(),
                                                       Vector3<float>(Vector3<float>::Unit(axis)));
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

}  // namespace hashphase::demos
