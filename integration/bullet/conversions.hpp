// SPDX-License-Identifier: Zlib
#pragma once

// Conversions between the vectors of Bullet and the grid. Nothing is rounded, because both use btScalar. NaN and
// infinite coordinates stay unchanged.
//
//     const Aabb<btScalar> box = toAabb(aabbMin, aabbMax);
//     broadphase.grid().visit(BoxRegion<btScalar>{box}, collector);

#include <broadphase/aabb.hpp>
#include <integration/bullet/precision.hpp>

#include <LinearMath/btVector3.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Returns the vector without Bullet's fourth component.
[[nodiscard]] inline Vector3<btScalar> toEigen(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}

/// Returns the vector; Bullet's fourth component is 0.
[[nodiscard]] inline btVector3 toBullet(const Vector3<btScalar>& v) {
    return {v.x(), v.y(), v.z()};
}

using hashphase::isSameBits;

/// Returns whether all three coordinates of `a` and `b` have equal bits: -0 and 0 differ; a NaN equals itself.
[[nodiscard]] inline bool isSameBits(const btVector3& a, const btVector3& b) {
    return isSameBits(a.x(), b.x()) && isSameBits(a.y(), b.y()) && isSameBits(a.z(), b.z());
}

/// Returns the box from `min` to `max`, inverted if min > max on an axis.
[[nodiscard]] inline Aabb<btScalar> toAabb(const btVector3& min, const btVector3& max) {
    return {toEigen(min), toEigen(max)};
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
