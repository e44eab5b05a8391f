// SPDX-License-Identifier: Zlib
//
// What programs do that have Bullet: a ray down and the radius added, or a sphere that is swept down.

#include <demos/accuracy/terrain/ground_methods.hpp>

#include <integration/bullet/conversions.hpp>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

/// The nearest hit of a ray, its triangle and its normal.
struct NearestHit : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;

    btScalar reportHit(const btVector3& hitNormal, btScalar fraction, int /*part*/,
                       int index) override {
        normal = hitNormal;
        triangle = index;
        return fraction;
    }

    btVector3 normal{0, 1, 0};
    int triangle = 0;
};

struct BulletMesh {
    explicit BulletMesh(const GroundMesh& mesh)
        : vertices(mesh.vertices()),
          indices(mesh.indices().begin(), mesh.indices().end()),
          array(static_cast<int>(mesh.triangles()), indices.data(), 3 * sizeof(int),
                static_cast<int>(vertices.size()), vertices.data()->data(), sizeof(Vector3<float>)),
          shape(&array, true) {}

    std::vector<Vector3<float>> vertices;
    std::vector<int> indices;
    btTriangleIndexVertexArray array;
    btBvhTriangleMeshShape shape;
};

/// The vertices' heights, without their places.
struct BulletHeightfield {
    explicit BulletHeightfield(const GroundMesh& mesh) : heights(heightsOf(mesh)) {
        shape.setLocalScaling({GroundMesh::kEdge, 1, GroundMesh::kEdge});
        shape.buildAccelerator();
    }

    // Bullet puts the middle of the range that it is told at 0.
    static float reachOf(const std::vector<float>& heights) {
        const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
        return std::max(std::abs(*low), std::abs(*high)) + 1;
    }
    static std::vector<float> heightsOf(const GroundMesh& mesh) {
        std::vector<float> heights;
        for (const Vector3<float>& vertex : mesh.vertices()) {
            heights.push_back(vertex.y());
        }
        return heights;
    }

    std::vector<float> heights;
    btHeightfieldTerrainShape shape{GroundMesh::kQuads + 1,
                                    GroundMesh::kQuads + 1,
                                    static_cast<const float*>(heights.data()),
                                    -reachOf(heights),
                                    reachOf(heights),
                                    1,
                                    false};
};

/// A ray straight down through a shape; then up by the radius, or by what is right on a slope.
template <class Ground>
class RayDown final : public GroundFinder {
public:
    RayDown(const GroundMesh& mesh, bool minds, bool tellsTriangle)
        : ground_(mesh),
          below_(mesh.bounds().min().y() - 1),
          mindsSlope_(minds),
          tellsTriangle_(tellsTriangle) {}

    void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) override {
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const btVector3 from = toBullet(spheres.centers[i]);
            const btVector3 to(from.x(), below_, from.z());
            NearestHit hit(from, to);
            ground_.shape.performRaycast(&hit, from, to);
            found[i].reset();
            if (hit.m_hitFraction < 1) {
                const float up = mindsSlope_ ? std::abs(hit.normal.normalized().y()) : 1.0F;
                const float height = from.y() + hit.m_hitFraction * (to.y() - from.y());
                found[i] = Standing{
                    height + spheres.radii[i] / up,
                    tellsTriangle_ ? static_cast<std::uint32_t>(hit.triangle) : Standing::kUntold};
            }
        }
    }

private:
    Ground ground_;
    float below_;  // where rays end
    bool mindsSlope_;
    bool tellsTriangle_;
};

/// btCollisionWorld::convexSweepTest() of the sphere.
class SweepDown final : public GroundFinder {
public:
    explicit SweepDown(const GroundMesh& mesh) : mesh_(mesh), below_(mesh.bounds().min().y() - 1) {
        ground_.setCollisionShape(&mesh_.shape);
        world_.addCollisionObject(&ground_);
    }
    ~SweepDown() override { world_.removeCollisionObject(&ground_); }

    void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) override {
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const btVector3 from = toBullet(spheres.centers[i]);
            const btVector3 to(from.x(), below_, from.z());
            const btSphereShape sphere(spheres.radii[i]);
            btCollisionWorld::ClosestConvexResultCallback hit(from, to);
            world_.convexSweepTest(&sphere, btTransform(btQuaternion::getIdentity(), from),
                                   btTransform(btQuaternion::getIdentity(), to), hit);
            found[i].reset();
            if (hit.hasHit()) {
                found[i] = Standing{from.y() + hit.m_closestHitFraction * (to.y() - from.y())};
            }
        }
    }

private:
    BulletMesh mesh_;
    float below_;  // where sweeps end
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
    btCollisionObject ground_;
};

template <class Ground>
GroundMethod rayMethod(std::string name, bool mindsSlope, bool isRegular) {
    GroundMethod method;
    method.name = std::move(name);
    method.needsRegular = isRegular;
    method.make = [=](const GroundMesh& mesh, float /*cellSize*/) {
        return std::make_unique<RayDown<Ground>>(mesh, mindsSlope, !isRegular);
    };
    return method;
}

}  // namespace

std::vector<GroundMethod> bulletGroundMethods() {
    GroundMethod sweep;
    sweep.name = "Bullet: sphere swept down";
    sweep.findsPoints = false;
    sweep.make = [](const GroundMesh& mesh, float /*cellSize*/) {
        return std::make_unique<SweepDown>(mesh);
    };
    return {rayMethod<BulletMesh>("Bullet: ray at mesh, + r", false, false),
            rayMethod<BulletMesh>("Bullet: ray at mesh, + r / n_y", true, false),
            rayMethod<BulletHeightfield>("Bullet: ray at heightfield, + r", false, true), sweep};
}

}  // namespace hashphase::demos
