// SPDX-License-Identifier: Zlib
#pragma once

// The triangles of Bullet's static shapes, for a Terrain:
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

/// Appends the triangles of a shape at `transform` to `corners`: three corners each, in world coordinates [m]. They
/// come in Bullet's order, which is not the mesh's. Corners that triangles share stay equal to the bit.
///
/// Shapes: btBvhTriangleMeshShape, btScaledBvhTriangleMeshShape, btHeightfieldTerrainShape, any other
/// btConcaveShape that lists its triangles, and compounds of these.
/// Returns an empty string, or a sentence about the fault; then nothing is appended. Faults: a shape or child
/// without triangles (a plane, a convex shape, a heightfield with a negative scaling), and compounds more than 64
/// deep within each other, or within themselves.
/// Cost: O(triangles), and the children of compounds, each as often as it is contained.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string appendTriangles(
    const btCollisionShape& shape, const btTransform& transform,
    std::vector<Vector3<btScalar>>& corners);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
