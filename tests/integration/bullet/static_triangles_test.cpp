// SPDX-License-Identifier: Zlib

// The triangles of static shapes: the ground made of them is where the shapes' own ray tests hit.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/static_triangles.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/support/random.hpp>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using Corners = std::vector<Vector3<btScalar>>;

constexpr int kSide = 24;  // vertices

double hill(double x, double z) {
    return 1.5 * std::sin(0.7 * x) + std::cos(0.9 * z + 0.3 * x);
}

/// A mesh of hills over a square of 23 m around the origin.
struct HillMesh {
    HillMesh() {
        for (int k = 0; k < kSide; ++k) {
            for (int i = 0; i < kSide; ++i) {
                const double x = i - 0.5 * (kSide - 1);
                const double z = k - 0.5 * (kSide - 1);
                vertices.emplace_back(btScalar(x), btScalar(hill(x, z)), btScalar(z));
            }
        }
        for (int k = 0; k + 1 < kSide; ++k) {
            for (int i = 0; i + 1 < kSide; ++i) {
                const int a = k * kSide + i;
                for (const int corner : {a, a + 1, a + kSide, a + 1, a + kSide, a + kSide + 1}) {
                    indices.push_back(corner);
                }
            }
        }
        array = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(indices.size() / 3), indices.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(vertices.size()), vertices.data()->m_floats,
            static_cast<int>(sizeof(btVector3)));
    }

    std::vector<btVector3> vertices;
    std::vector<int> indices;
    std::unique_ptr<btTriangleIndexVertexArray> array;
};

/// Heights of hills for a heightfield; `up` is 0, 1 or 2.
struct HillField {
    HillField(int up, bool flipEdges) {
        for (int k = 0; k < kSide; ++k) {
            for (int i = 0; i < kSide; ++i) {
                heights.push_back(static_cast<float>(hill(i, k)));
            }
        }
        shape = std::make_unique<btHeightfieldTerrainShape>(
            kSide, kSide, heights.data(), btScalar(-3), btScalar(5), up, flipEdges);
    }

    std::vector<float> heights;
    std::unique_ptr<btHeightfieldTerrainShape> shape;
};

btTransform somewhere(bool isTilted) {
    const btQuaternion turn(btScalar(0.8), btScalar(0.3), btScalar(-0.2));
    return btTransform(isTilted ? turn : btQuaternion::getIdentity(),
                       btVector3(btScalar(30.25), btScalar(-7.5), btScalar(11)));
}

/// Where a ray of Bullet's meets a shape, as a fraction of the ray; 1 where it does not.
using CastRay = btScalar (*)(const btVector3& from, const btVector3& to,
                             const btCollisionShape& shape, const btTransform& transform);

btScalar castByWorld(const btVector3& from, const btVector3& to, const btCollisionShape& shape,
                     const btTransform& transform) {
    btCollisionObject object;
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), from),
                                    btTransform(btQuaternion::getIdentity(), to), &object, &shape,
                                    transform, hit);
    return hit.m_closestHitFraction;
}

/// The triangles that a collision sees. Bullet 3.24 cuts the quads of a heightfield with diamonds or
/// zigzags along other diagonals where it casts rays than where it collides.
btScalar castByTriangles(const btVector3& from, const btVector3& to, const btCollisionShape& shape,
                         const btTransform& transform) {
    struct ClosestTriangle : btTriangleRaycastCallback {
        using btTriangleRaycastCallback::btTriangleRaycastCallback;
        btScalar reportHit(const btVector3& /*normal*/, btScalar fraction, int /*part*/,
                           int /*index*/) override {
            return fraction;
        }
    };
    const btTransform toLocal = transform.inverse();
    ClosestTriangle closest(toLocal * from, toLocal * to);
    btVector3 min = toLocal * from;
    btVector3 max = min;
    min.setMin(toLocal * to);
    max.setMax(toLocal * to);
    static_cast<const btConcaveShape&>(shape).processAllTriangles(&closest, min, max);
    return closest.m_hitFraction;
}

/// Casts rays down (along `up`) around the shape's place, and asks the ground there.
void expectHeightsOfRays(const btCollisionShape& shape, const btTransform& transform, UpAxis up,
                         CastRay castRay = castByWorld) {
    Corners corners;
    ASSERT_EQ(appendTriangles(shape, transform, corners), "");
    Grid<btScalar> grid;
    Terrain<btScalar> terrain(grid, up);
    ASSERT_TRUE(terrain.add(corners).refused.empty());
    grid.update();
    const int y = static_cast<int>(up);
    // Bullet lets rays hit what is up to a ten-thousandth of its size beside them.
    constexpr double kTolerance = 1e-3;
    Random random(0x5eed2501);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        btVector3 from = transform.getOrigin() + toBullet(random.pointIn(-9, 9).cast<btScalar>());
        btVector3 to = from;
        from[y] = transform.getOrigin()[y] + 40;
        to[y] = transform.getOrigin()[y] - 40;
        const btScalar fraction = castRay(from, to, shape, transform);
        const auto ground = terrain.surfaceBelow(toEigen(from));
        ASSERT_EQ(ground.has_value(), fraction < 1) << "at " << toEigen(from).transpose();
        if (ground) {
            ++hits;
            ASSERT_NEAR(ground->height, from[y] - 80 * fraction, kTolerance)
                << "at " << toEigen(from).transpose();
        }
    }
    EXPECT_GE(hits, 1500);
}

TEST(StaticTriangles, OfMeshesAreWhereRaysHit) {
    const HillMesh mesh;
    for (const bool isQuantized : {false, true}) {
        const btBvhTriangleMeshShape shape(mesh.array.get(), isQuantized);
        for (const bool isTilted : {false, true}) {
            expectHeightsOfRays(shape, somewhere(isTilted), UpAxis::y);
        }
    }
}

TEST(StaticTriangles, OfScaledMeshesAreWhereRaysHit) {
    const HillMesh mesh;
    btBvhTriangleMeshShape shape(mesh.array.get(), true);
    for (const btVector3& scaling :
         {btVector3(1, btScalar(2.5), 1), btVector3(btScalar(-1.5), 1, btScalar(0.75))}) {
        const btScaledBvhTriangleMeshShape scaled(&shape, scaling);
        expectHeightsOfRays(scaled, somewhere(true), UpAxis::y);
    }
}

TEST(StaticTriangles, OfHeightfieldsAreWhereRaysHit) {
    for (const int up : {0, 1, 2}) {
        for (const bool isFlipped : {false, true}) {
            for (int option = 0; option < 4; ++option) {
                SCOPED_TRACE(testing::Message() << "up " << up << ", option " << option);
                HillField field(up, isFlipped);
                field.shape->setFlipTriangleWinding(option == 1);
                field.shape->setUseDiamondSubdivision(option == 2);
                field.shape->setUseZigzagSubdivision(option == 3);
                field.shape->setLocalScaling(
                    btVector3(btScalar(1.25), btScalar(0.8), btScalar(1.5)));
                expectHeightsOfRays(*field.shape, somewhere(false), static_cast<UpAxis>(up),
                                    option < 2 ? castByWorld : castByTriangles);
                Corners corners;
                ASSERT_EQ(appendTriangles(*field.shape, somewhere(false), corners), "");
                EXPECT_EQ(corners.size(), 3U * 2U * (kSide - 1) * (kSide - 1));
            }
        }
    }
}

TEST(StaticTriangles, OfCompoundsAreThoseOfTheirChildren) {
    const HillMesh mesh;
    btBvhTriangleMeshShape shape(mesh.array.get(), true);
    HillField field(1, false);
    btCompoundShape inner;
    inner.addChildShape(somewhere(true).inverse(), &shape);
    btCompoundShape outer;
    outer.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(2, 3, btScalar(-1.5))),
                        field.shape.get());
    outer.addChildShape(somewhere(true), &inner);
    expectHeightsOfRays(outer, somewhere(false), UpAxis::y);
    Corners corners;
    ASSERT_EQ(appendTriangles(outer, somewhere(false), corners), "");
    EXPECT_EQ(corners.size(), 2 * 3U * 2U * (kSide - 1) * (kSide - 1));
}

TEST(StaticTriangles, AreNotToBeHadFromPlanesAndConvexShapes) {
    const HillMesh mesh;
    btBvhTriangleMeshShape shape(mesh.array.get(), true);
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    btBoxShape box(btVector3(1, 1, 1));
    btSphereShape sphere(1);
    btEmptyShape empty;
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &shape);
    compound.addChildShape(btTransform::getIdentity(), &box);
    btCompoundShape childless;
    Corners corners(3, Vector3<btScalar>::Zero());
    const auto errorOf = [&](const btCollisionShape& of) {
        std::string error = appendTriangles(of, somewhere(true), corners);
        EXPECT_EQ(corners.size(), 3U);
        return error;
    };
    const std::vector<std::pair<const btCollisionShape*, const char*>> refused{
        {&plane, "STATICPLANE"},
        {&box, "Box"},
        {&sphere, "SPHERE"},
        {&empty, "Empty"},
        {&compound, "Child 1 of a compound: A shape of the kind Box"}};
    for (const auto& [of, part] : refused) {
        EXPECT_NE(errorOf(*of).find(part), std::string::npos) << part;
    }
    EXPECT_EQ(errorOf(childless), "");
    btCompoundShape endless(false);
    endless.addChildShape(btTransform::getIdentity(), &shape);
    endless.addChildShape(btTransform::getIdentity(), &childless);
    endless.getChildList()[1].m_childShape = &endless;
    EXPECT_NE(errorOf(endless).find("one contains itself"), std::string::npos);
    endless.getChildList()[1].m_childShape = &box;
}

/// Four heightfields of hills side by side around the origin, 23 m each, and as one scaled mesh each
/// where `areMeshes`, all turned as one.
void addChunks(Terrain<btScalar>& terrain, const btTransform& turned, bool areMeshes) {
    constexpr int kQuads = kSide - 1;
    for (const int row : {-1, 0}) {
        for (const int column : {-1, 0}) {
            std::vector<float> heights;
            for (int i = 0; i < kSide * kSide; ++i) {
                heights.push_back(static_cast<float>(
                    hill(column * kQuads + i % kSide, row * kQuads + i / kSide)));
            }
            const btHeightfieldTerrainShape field(kSide, kSide, heights.data(), btScalar(-3),
                                                  btScalar(5), 1, column == 0);
            const btVector3 middle(btScalar((column + 0.5) * kQuads), 0,
                                   btScalar((row + 0.5) * kQuads));
            const btTransform place(btQuaternion::getIdentity(), middle);
            Corners corners;
            if (areMeshes) {
                const btScalar scale = btScalar(1.5);
                ASSERT_EQ(appendTriangles(field, btTransform::getIdentity(), corners), "");
                btTriangleMesh mesh;
                for (std::size_t i = 0; i < corners.size(); i += 3) {
                    mesh.addTriangle(toBullet(corners[i]) / scale, toBullet(corners[i + 1]) / scale,
                                     toBullet(corners[i + 2]) / scale);
                }
                corners.clear();
                btBvhTriangleMeshShape shape(&mesh, true);
                const btScaledBvhTriangleMeshShape scaled(&shape, btVector3(scale, scale, scale));
                ASSERT_EQ(appendTriangles(scaled, turned * place, corners), "");
            } else {
                ASSERT_EQ(appendTriangles(field, turned * place, corners), "");
            }
            terrain.add(corners);
        }
    }
}

TEST(StaticTriangles, OfTurnedNeighboursLeaveNoPointOnTheirSeamsWithoutGround) {
    Random random(0x5eed2502);
    for (int turn = 0; turn < 12; ++turn) {
        const auto tilt = static_cast<btScalar>(turn % 2 == 0 ? 0 : random.between(-0.2, 0.2));
        const btTransform turned(
            btQuaternion(btVector3(tilt, 1, -tilt).normalized(), btScalar(turn) + btScalar(0.3)),
            toBullet(random.pointIn(-1, 1).cast<btScalar>() * btScalar(turn % 3 == 0 ? 0 : 500)));
        Grid<btScalar> grid;
        Terrain<btScalar> terrain(grid);
        addChunks(terrain, turned, turn % 4 == 3);
        grid.update();
        std::vector<Vector3<btScalar>> points;
        for (int i = 0; i < 4000; ++i) {
            const double along = i == 0 ? 0.0 : random.between(-20, 20);
            const double x = i % 2 == 0 ? 0 : along;
            const double z = i % 2 == 0 ? along : 0;
            points.push_back(toEigen(turned * btVector3(btScalar(x), btScalar(9), btScalar(z))));
        }
        std::vector<std::optional<Ground<btScalar>>> below(points.size());
        std::vector<std::optional<Ground<btScalar>>> resting(points.size());
        const std::vector<btScalar> radii(points.size(), btScalar(1e-7));
        terrain.surfacesBelow(points, below);
        terrain.restingHeights(points, radii, resting);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_TRUE(below[i] && resting[i]) << "turn " << turn << ", point " << i;
            ASSERT_EQ(below[i], terrain.surfaceBelow(points[i]));
            ASSERT_NEAR(below[i]->height, resting[i]->height, 1e-2);
        }
    }
}

}  // namespace
}  // namespace hashphase::test
