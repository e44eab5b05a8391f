// SPDX-License-Identifier: Zlib
#include <integration/bullet/static_triangles.hpp>

#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

class AppendCorners : public btTriangleCallback {
public:
    AppendCorners(const btTransform& transform, std::vector<Vector3<btScalar>>& corners)
        : transform_(transform), corners_(corners) {}

    void processTriangle(btVector3* triangle, int /*part*/, int /*index*/) override {
        for (int i = 0; i < 3; ++i) {
            corners_.push_back(toEigen(transform_ * triangle[i]));
        }
    }

private:
    const btTransform& transform_;
    std::vector<Vector3<btScalar>>& corners_;
};

// Deeper are only compounds that contain themselves.
constexpr int kDeepest = 64;

std::string append(const btCollisionShape& shape, const btTransform& transform,
                   std::vector<Vector3<btScalar>>& corners, int depth = 0) {
    if (depth > kDeepest) {
        return "compounds are nested more than 64 deep, or one contains itself. Use fewer levels "
               "of compounds.";
    }
    if (shape.isCompound()) {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i) {
            const std::string error =
                append(*compound.getChildShape(i), transform * compound.getChildTransform(i),
                       corners, depth + 1);
            if (!error.empty()) {
                return "Child " + std::to_string(i) + " of a compound: " + error;
            }
        }
        return {};
    }
    const std::size_t before = corners.size();
    // A plane is concave to Bullet, and makes up two triangles as large as the box that it is given.
    if (shape.isConcave() && shape.getShapeType() != STATIC_PLANE_PROXYTYPE) {
        // Finite, as heightfields and quantised trees convert it to integers; they clamp it first.
        const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        AppendCorners callback(transform, corners);
        static_cast<const btConcaveShape&>(shape).processAllTriangles(&callback, -far, far);
    }
    if (corners.size() == before) {
        return std::string("A shape of the kind ") + shape.getName() +
               " has no triangles. Pass a mesh, a heightfield, or a compound of these.";
    }
    return {};
}

}  // namespace

std::string appendTriangles(const btCollisionShape& shape, const btTransform& transform,
                            std::vector<Vector3<btScalar>>& corners) {
    const std::size_t before = corners.size();
    std::string error = append(shape, transform, corners);
    if (!error.empty()) {
        corners.resize(before);
    }
    return error;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
