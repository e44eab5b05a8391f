// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>

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

/// The paper's terrain: all triangles in a map of cells, the one that has the point within its
/// three corners on the map, the height between them. A point that rounding puts outside of both
/// triangles at an edge has none. The paper lifts the sphere by its radius; what is right on a
/// slope without end is to divide by the normal's height.
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
GroundFinder terrainGround(const GroundMesh& mesh, float cellSize, bool allAtOnce) {
    struct Filed {
        Grid<float> grid;
        Terrain<float> terrain{grid};
        std::vector<Terrain<float>::Found> grounds;

        explicit Filed(double size) : grid({.cellSize = size}) {}
    };
    const auto filed = std::make_shared<Filed>(static_cast<double>(cellSize));
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

// --- What programs do that have Bullet -----------------------------------------------------------

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

/// The vertices' heights, without their places. Bullet puts the middle of the range that it is told
/// at 0.
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

/// Where something that goes down stops.
struct Stop {
    btScalar fraction;                      // of its way
    float lift;                             // up to the centre [m]
    std::optional<std::uint32_t> triangle;  // where it is told
};

/// Each sphere by itself: stop(from, to, radius), nothing without ground, on the way straight down.
template <class FindStop>
GroundFinder straightDown(const GroundMesh& mesh, const FindStop& findStop) {
    const float below = mesh.bounds().min().y() - 1;
    return oneByOne([=](const Vector3<float>& center, float radius) {
        const btVector3 from = toBullet(center);
        const std::optional<Stop> stop =
            findStop(from, btVector3(from.x(), below, from.z()), radius);
        return stop ? std::optional(
                          Standing{from.y() + stop->fraction * (below - from.y()) + stop->lift,
                                   stop->triangle})
                    : std::nullopt;
    });
}

/// The nearest hit of a ray at a shape, its triangle and its normal.
template <class Shape>
struct NearestHit : btTriangleRaycastCallback {
    NearestHit(Shape& shape, const btVector3& from, const btVector3& to)
        : btTriangleRaycastCallback(from, to) {
        shape.performRaycast(this, from, to);
    }

    btScalar reportHit(const btVector3& hitNormal, btScalar fraction, int /*part*/,
                       int index) override {
        normal = hitNormal;
        triangle = static_cast<std::uint32_t>(index);
        return fraction;
    }

    btVector3 normal{0, 1, 0};
    std::uint32_t triangle = 0;
};

/// A ray; then up by the radius, or by what is right on a slope.
GroundFinder rayAtMesh(const GroundMesh& mesh, bool mindsSlope) {
    const auto filed = std::make_shared<BulletMesh>(mesh);
    return straightDown(mesh, [=](const btVector3& from, const btVector3& to, float radius) {
        const NearestHit hit(filed->shape, from, to);
        const float up = mindsSlope ? std::abs(hit.normal.normalized().y()) : 1.0F;
        return hit.m_hitFraction < 1
                   ? std::optional(Stop{hit.m_hitFraction, radius / up, hit.triangle})
                   : std::nullopt;
    });
}

GroundFinder rayAtHeightfield(const GroundMesh& mesh, float /*cellSize*/) {
    const auto filed = std::make_shared<BulletHeightfield>(mesh);
    return straightDown(mesh, [=](const btVector3& from, const btVector3& to, float radius) {
        const NearestHit hit(*filed->shape, from, to);
        return hit.m_hitFraction < 1 ? std::optional(Stop{hit.m_hitFraction, radius, {}})
                                     : std::nullopt;
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
    return straightDown(mesh, [=](const btVector3& from, const btVector3& to, float radius) {
        const btSphereShape sphere(radius);
        btCollisionWorld::ClosestConvexResultCallback hit(from, to);
        filed->world.convexSweepTest(&sphere, btTransform(btQuaternion::getIdentity(), from),
                                     btTransform(btQuaternion::getIdentity(), to), hit);
        return hit.hasHit() ? std::optional(Stop{hit.m_closestHitFraction, 0, {}}) : std::nullopt;
    });
}

}  // namespace

std::vector<GroundMethod> groundMethods() {
    const auto paper = [](bool mindsSlope) {
        return
            [=](const GroundMesh& mesh, float size) { return paperGround(mesh, size, mindsSlope); };
    };
    const auto ray = [](bool mindsSlope) {
        return [=](const GroundMesh& mesh, float) { return rayAtMesh(mesh, mindsSlope); };
    };
    const auto ours = [&](std::string name, bool allAtOnce, bool takesCells) {
        return GroundMethod{.name = std::move(name),
                            .make =
                                [=](const GroundMesh& mesh, float size) {
                                    return terrainGround(mesh, takesCells ? size : 0, allAtOnce);
                                },
                            .isOurs = true,
                            .mustRest = true,
                            .takesCells = takesCells};
    };
    return {
        {.name = "paper: height + r",
         .make = paper(false),
         .sinksByLine = true,
         .takesCells = true},
        {.name = "height + r / n_y", .make = paper(true), .takesCells = true},
        ours("Terrain, one by one", false, false),
        ours("Terrain, all at once", true, false),
        ours("Terrain, all at once, fixed cells", true, true),
        {.name = "Bullet: ray at mesh, + r", .make = ray(false)},
        {.name = "Bullet: ray at mesh, + r / n_y", .make = ray(true)},
        {.name = "Bullet: ray at heightfield, + r", .make = rayAtHeightfield, .findsPoints = false},
        {.name = "Bullet: sphere swept down", .make = sweepDown, .findsPoints = false},
    };
}

}  // namespace hashphase::demos
