// SPDX-License-Identifier: Zlib
#pragma once

// Reads the triangles of Bullet's static shapes, for a Terrain:
//
//     std::vector<Vector3<btScalar>> corners;
//     const btCollisionShape& shape = *body.getCollisionShape();
//     const std::string error = appendTriangles(shape, body.getWorldTransform(), corners);
//     terrain.add(corners);  // integration/terrain

#include <broadphase/aabb.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btTransform.h>

#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Appends the triangles of a shape at `transform` to `corners`: three corners for each triangle, in world
/// coordinates [m]. The order of triangles is Bullet's, not the mesh's. If triangles share a corner, it has equal
/// bits in all of them.
///
/// Shapes: btBvhTriangleMeshShape, btScaledBvhTriangleMeshShape, btHeightfieldTerrainShape, any other btConcaveShape
/// whose processAllTriangles() reports triangles (except btStaticPlaneShape), and compounds of these shapes.
/// Returns an empty string, or a sentence about the fault. If there is a fault, appends nothing. Faults: a plane, a
/// shape or child without triangles (a convex shape, a heightfield with a negative scaling; but not a compound
/// without children), compounds nested more than 64 deep, or a compound that contains itself.
/// Cost: O(triangles + children of compounds). If a shape occurs several times, each occurrence counts.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string appendTriangles(
    const btCollisionShape& shape, const btTransform& transform,
    std::vector<Vector3<btScalar>>& corners);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
