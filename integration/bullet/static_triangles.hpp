// SPDX-License-Identifier: Zlib
#pragma once

// The triangles of Bullet's static shapes, for whoever wants to know the ground:
//
//     std::vector<Vector3<btScalar>> corners;
//     const std::string error = appendTriangles(*body.getCollisionShape(), body.getWorldTransform(), corners);
//     terrain.add(corners);  // integration/terrain

#include <broadphase/aabb.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btTransform.h>

#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Appends the triangles of a shape that stands at `transform` to `corners`, in world coordinates,
/// three corners each: of a btBvhTriangleMeshShape, a btScaledBvhTriangleMeshShape, a
/// btHeightfieldTerrainShape, any other btConcaveShape that lists its triangles, and of compounds of
/// these. They come in Bullet's order, which is not the mesh's; corners that triangles share stay
/// equal to the bit. Returns nothing; or, where the shape or a child of it has no triangles (a plane,
/// a convex shape), or compounds lie more than 64 deep within each other, as one that contains itself
/// does, a sentence that says so, and then nothing was appended. A heightfield with a negative scaling
/// has none either: Bullet itself finds none there. Cost: O(triangles), and the children of
/// compounds, each as often as it is contained.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string appendTriangles(
    const btCollisionShape& shape, const btTransform& transform,
    std::vector<Vector3<btScalar>>& corners);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
