// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/ground_methods.hpp>

#include <demos/accuracy/baselines/paper_map.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/terrain/terrain.hpp>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace hashphase::demos {
namespace {

/// Asks for each sphere by itself: standing(center, radius).
template <class Stand>
GroundFinder oneByOne(const Stand& standing) {
    return [standing](const SphereBatch& spheres, std::span<std::optional<Standing>> found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            found[i] = standing(spheres.centers[i], spheres.radii[i]);
        }
    };
}

/// The paper's terrain: all triangles in a map of cells, the one that has the point within its three
/// corners on the map, the height between them. A point that rounding puts outside of both triangles
/// at an edge has none. The paper lifts the sphere by its radius; what is right on a slope without end is
/// to divide by the normal's height.
GroundFinder paperGround(const GroundMesh& mesh, float cellSize, bool mindsSlope) {
    const auto map = std::make_shared<PaperMap>(mesh.triangleBoxes(), cellSize);
    return oneByOne([=](const Vector3<float>& p, float radius) -> std::optional<Standing> {
        const PaperMap::Cell cell = map->cellAt(p.x(), p.z());
        for (const std::uint32_t triangle : map->objects(cell.x, cell.z)) {
            const Vector3<float>& a = mesh.corner(triangle, 0);
            const Vector3<float> ab = mesh.corner(triangle, 1) - a;
            const Vector3<float> ac = mesh.corner(triangle, 2) - a;
            const Vector3<float> ap = p - a;
            const float area = ab.x() * ac.z() - ab.z() * ac.x();
            const float u = (ap.x() * ac.z() - ap.z() * ac.x()) / area;
            const float v = (ab.x() * ap.z() - ab.z() * ap.x()) / area;
            if (u >= 0 && v >= 0 && u + v <= 1) {
                const float up = mindsSlope ? std::abs(ab.cross(ac).normalized().y()) : 1.0F;
                return Standing{a.y() + u * ab.y() + v * ac.y() + radius / up, triangle};
            }
        }
        return std::nullopt;
    });
}

/// The library's. Points ask for the surface.
GroundFinder terrainGround(const GroundMesh& mesh, double cellSize, bool allAtOnce) {
    struct Filed {
        Grid<float> grid;
        Terrain<float> terrain{grid};
        std::vector<Terrain<float>::Found> grounds;

        explicit Filed(double size) : grid({.cellSize = size}) {}
    };
    const auto filed = std::make_shared<Filed>(cellSize);
    filed->terrain.add(mesh.vertices, mesh.indices);
    filed->grid.update();
    const auto standing = [](const Terrain<float>::Found& ground) {
        return ground ? std::optional(Standing{ground->height, ground->triangle}) : std::nullopt;
    };
    if (!allAtOnce) {
        return oneByOne([=](const Vector3<float>& center, float radius) {
            return standing(radius > 0 ? filed->terrain.restingHeight(center, radius)
                                       : filed->terrain.surfaceBelow(center));
        });
    }
    return [=](const SphereBatch& spheres, std::span<std::optional<Standing>> found) {
        filed->grounds.resize(found.size());
        filed->terrain.restingHeights(spheres.centers, spheres.radii, filed->grounds);
        std::transform(filed->grounds.begin(), filed->grounds.end(), found.begin(), standing);
    };
}

// --- What programs do that have Bullet ----------------------------------------------------------------

struct BulletMesh {
    explicit BulletMesh(const GroundMesh& mesh)
        : vertices(mesh.vertices),
          indices(mesh.indices.begin(), mesh.indices.end()),
          array(static_cast<int>(mesh.triangles()), indices.data(), 3 * sizeof(int),
                static_cast<int>(vertices.size()), vertices.data()->data(), sizeof(Vector3<float>)),
          shape(&array, true) {}

    std::vector<Vector3<float>> vertices;
    std::vector<int> indices;
    btTriangleIndexVertexArray array;
    btBvhTriangleMeshShape shape;
};

/// The vertices' heights, without their places. Bullet puts the middle of the range that it is told at 0.
struct BulletHeightfield {
    explicit BulletHeightfield(const GroundMesh& mesh)
        : reach(mesh.bounds().min().cwiseAbs().cwiseMax(mesh.bounds().max().cwiseAbs()).y() + 1) {
        for (const Vector3<float>& vertex : mesh.vertices) {
            heights.push_back(vertex.y());
        }
        shape = std::make_unique<btHeightfieldTerrainShape>(
            GroundMesh::kQuads + 1, GroundMesh::kQuads + 1,
            static_cast<const float*>(heights.data()), -reach, reach, 1, false);
        shape->setLocalScaling({GroundMesh::kEdge, 1, GroundMesh::kEdge});
        shape->buildAccelerator();
    }

    float reach;
    std::vector<float> heights;
    std::unique_ptr<btHeightfieldTerrainShape> shape;
};

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

/// A ray straight down, cast(hit, from, to); then up by the radius, or by what is right on a slope.
template <class Cast>
GroundFinder rayDown(const GroundMesh& mesh, bool mindsSlope, bool tellsTriangle,
                     const Cast& cast) {
    const float below = mesh.bounds().min().y() - 1;
    return oneByOne([=](const Vector3<float>& center, float radius) -> std::optional<Standing> {
        const btVector3 from = toBullet(center);
        const btVector3 to(from.x(), below, from.z());
        NearestHit hit(from, to);
        cast(hit, from, to);
        if (hit.m_hitFraction >= 1) {
            return std::nullopt;
        }
        const float up = mindsSlope ? std::abs(hit.normal.normalized().y()) : 1.0F;
        Standing standing{from.y() + hit.m_hitFraction * (below - from.y()) + radius / up, {}};
        if (tellsTriangle) {
            standing.triangle = static_cast<std::uint32_t>(hit.triangle);
        }
        return standing;
    });
}

GroundFinder rayAtMesh(const GroundMesh& mesh, bool mindsSlope) {
    return rayDown(mesh, mindsSlope, true,
                   [filed = std::make_shared<BulletMesh>(mesh)](
                       NearestHit& hit, const btVector3& from, const btVector3& to) {
                       filed->shape.performRaycast(&hit, from, to);
                   });
}

GroundFinder rayAtHeightfield(const GroundMesh& mesh, float /*cellSize*/) {
    return rayDown(mesh, false, false,
                   [filed = std::make_shared<BulletHeightfield>(mesh)](
                       NearestHit& hit, const btVector3& from, const btVector3& to) {
                       filed->shape->performRaycast(&hit, from, to);
                   });
}

/// btCollisionWorld::convexSweepTest() of the sphere.
GroundFinder sweepDown(const GroundMesh& mesh, float /*cellSize*/) {
    struct Filed {
        explicit Filed(const GroundMesh& ground) : mesh(ground) {
            object.setCollisionShape(&mesh.shape);
            world.addCollisionObject(&object);
        }
        ~Filed() { world.removeCollisionObject(&object); }

        BulletMesh mesh;
        btDefaultCollisionConfiguration configuration;
        btCollisionDispatcher dispatcher{&configuration};
        btDbvtBroadphase broadphase;
        btCollisionWorld world{&dispatcher, &broadphase, &configuration};
        btCollisionObject object;
    };
    const auto filed = std::make_shared<Filed>(mesh);
    const float below = mesh.bounds().min().y() - 1;
    return oneByOne([=](const Vector3<float>& center, float radius) -> std::optional<Standing> {
        const btVector3 from = toBullet(center);
        const btVector3 to(from.x(), below, from.z());
        const btSphereShape sphere(radius);
        btCollisionWorld::ClosestConvexResultCallback hit(from, to);
        filed->world.convexSweepTest(&sphere, btTransform(btQuaternion::getIdentity(), from),
                                     btTransform(btQuaternion::getIdentity(), to), hit);
        if (!hit.hasHit()) {
            return std::nullopt;
        }
        return Standing{from.y() + hit.m_closestHitFraction * (below - from.y()), {}};
    });
}

}  // namespace

std::vector<GroundMethod> groundMethods() {
    const auto paper = [](bool mindsSlope) {
        return
            [=](const GroundMesh& mesh, float size) { return paperGround(mesh, size, mindsSlope); };
    };
    const auto terrain = [](bool allAtOnce, bool takesCells) {
        return [=](const GroundMesh& mesh, float size) {
            return terrainGround(mesh, takesCells ? static_cast<double>(size) : 0, allAtOnce);
        };
    };
    const auto ray = [](bool mindsSlope) {
        return [=](const GroundMesh& mesh, float) { return rayAtMesh(mesh, mindsSlope); };
    };
    return {
        {.name = "paper: height + r",
         .make = paper(false),
         .sinksByLine = true,
         .takesCells = true},
        {.name = "height + r / n_y", .make = paper(true), .takesCells = true},
        {.name = "Terrain, one by one",
         .make = terrain(false, false),
         .isOurs = true,
         .mustRest = true},
        {.name = "Terrain, all at once",
         .make = terrain(true, false),
         .isOurs = true,
         .mustRest = true},
        {.name = "Terrain, all at once, fixed cells",
         .make = terrain(true, true),
         .isOurs = true,
         .mustRest = true,
         .takesCells = true},
        {.name = "Bullet: ray at mesh, + r", .make = ray(false)},
        {.name = "Bullet: ray at mesh, + r / n_y", .make = ray(true)},
        {.name = "Bullet: ray at heightfield, + r", .make = rayAtHeightfield, .findsPoints = false},
        {.name = "Bullet: sphere swept down", .make = sweepDown, .findsPoints = false},
    };
}

}  // namespace hashphase::demos
