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

Vector3<float> normalOf(const TriangleGround& mesh, std::size_t triangle) {
    const Vector3<float> ab = mesh.corner(triangle, 1) - mesh.corner(triangle, 0);
    return ab.cross(mesh.corner(triangle, 2) - mesh.corner(triangle, 0)).normalized();
}

/// The paper's terrain: all triangles in a map of cells, the one that has the point within its
/// three corners on the map, the height between them. A point that rounding puts outside of both
/// triangles at an edge has none. The paper lifts the sphere by its radius; what is right on a
/// slope without end is to divide by the normal's height.
GroundFinder paperGround(const TriangleGround& mesh, float cellSize, bool mindsSlope) {
    const auto map = std::make_shared<PaperMap>(mesh.boxes, cellSize);
    return oneByOne([=](const Vector3<float>& p, float radius) -> std::optional<Standing> {
        const PaperMap::Cell cell = map->cellAt(p.x(), p.z());
        for (const std::uint32_t triangle : map->objects(cell.x, cell.z)) {
            if (const auto height = mesh.heightAt(triangle, p.x(), p.z())) {
                const float up = mindsSlope ? std::abs(normalOf(mesh, triangle).y()) : 1.0F;
                return Standing{*height + radius / up, triangle};
            }
        }
        return std::nullopt;
    });
}

/// The library's. Points ask for the surface.
GroundFinder terrainGround(const TriangleGround& mesh, float cellSize, bool allAtOnce) {
    struct Filed {
        Grid<float> grid;
        hashphase::Terrain<float> terrain{grid};
        std::vector<hashphase::Terrain<float>::Found> grounds;

        explicit Filed(double size) : grid({.cellSize = size}) {}
    };
    const auto filed = std::make_shared<Filed>(static_cast<double>(cellSize));
    filed->terrain.add(mesh.vertices, mesh.indices);
    filed->grid.update();
    const auto standing = [](const hashphase::Terrain<float>::Found& ground) {
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
    explicit BulletMesh(const TriangleGround& mesh)
        : vertices(mesh.vertices),
          indices(mesh.indices.begin(), mesh.indices.end()),
          array(static_cast<int>(mesh.boxes.size()), indices.data(), 3 * sizeof(int),
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
    explicit BulletHeightfield(const TriangleGround& mesh)
        : reach(mesh.bounds().min().cwiseAbs().cwiseMax(mesh.bounds().max().cwiseAbs()).y() + 1) {
        for (const Vector3<float>& vertex : mesh.vertices) {
            heights.push_back(vertex.y());
        }
        shape = std::make_unique<btHeightfieldTerrainShape>(
            kGroundQuads + 1, kGroundQuads + 1, static_cast<const float*>(heights.data()), -reach,
            reach, 1, false);
        shape->setLocalScaling({kGroundEdge, 1, kGroundEdge});
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
GroundFinder straightDown(const TriangleGround& mesh, const FindStop& findStop) {
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
GroundFinder rayAtMesh(const TriangleGround& mesh, bool mindsSlope) {
    const auto filed = std::make_shared<BulletMesh>(mesh);
    return straightDown(mesh, [=](const btVector3& from, const btVector3& to, float radius) {
        const NearestHit hit(filed->shape, from, to);
        const float up = mindsSlope ? std::abs(hit.normal.normalized().y()) : 1.0F;
        return hit.m_hitFraction < 1
                   ? std::optional(Stop{hit.m_hitFraction, radius / up, hit.triangle})
                   : std::nullopt;
    });
}

GroundFinder rayAtHeightfield(const TriangleGround& mesh, float /*cellSize*/) {
    const auto filed = std::make_shared<BulletHeightfield>(mesh);
    return straightDown(mesh, [=](const btVector3& from, const btVector3& to, float radius) {
        const NearestHit hit(*filed->shape, from, to);
        return hit.m_hitFraction < 1 ? std::optional(Stop{hit.m_hitFraction, radius, {}})
                                     : std::nullopt;
    });
}

/// btCollisionWorld::convexSweepTest() of the sphere.
GroundFinder sweepDown(const TriangleGround& mesh, float /*cellSize*/) {
    struct Filed {
        explicit Filed(const TriangleGround& ground) : mesh(ground) {
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
    using Mesh = const TriangleGround&;
    const auto paper = [](bool mindsSlope) {
        return [=](Mesh mesh, float size) { return paperGround(mesh, size, mindsSlope); };
    };
    const auto terrain = [](bool allAtOnce, bool takesCells) {
        return [=](Mesh mesh, float size) {
            return terrainGround(mesh, takesCells ? size : 0, allAtOnce);
        };
    };
    const auto ray = [](bool mindsSlope) {
        return [=](Mesh mesh, float) { return rayAtMesh(mesh, mindsSlope); };
    };
    return {
        {"paper: height + r", "paper sinks_by_line takes_cells finds_points", paper(false)},
        {"height + r / n_y", "others takes_cells finds_points", paper(true)},
        {"Terrain, one by one", "ours must_rest finds_points", terrain(false, false)},
        {"Terrain, all at once", "ours must_rest finds_points", terrain(true, false)},
        {"Terrain, all at once, fixed cells", "ours must_rest takes_cells finds_points",
         terrain(true, true)},
        {"Bullet: ray at mesh, + r", "bullet finds_points", ray(false)},
        {"Bullet: ray at mesh, + r / n_y", "bullet finds_points", ray(true)},
        {"Bullet: ray at heightfield, + r", "bullet", rayAtHeightfield},
        {"Bullet: sphere swept down", "bullet", sweepDown},
    };
}

}  // namespace hashphase::demos
