// SPDX-License-Identifier: Zlib
#pragma once

// Which kind of algorithm Bullet makes for two shapes.

#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

enum class AlgorithmKind { leaf, compound, twoCompounds };

// As btDefaultCollisionConfiguration chooses.
[[nodiscard]] inline AlgorithmKind kindOf(const btCollisionShape& a, const btCollisionShape& b) {
    return a.isCompound() && b.isCompound()   ? AlgorithmKind::twoCompounds
           : a.isCompound() || b.isCompound() ? AlgorithmKind::compound
                                              : AlgorithmKind::leaf;
}

[[nodiscard]] inline const btCompoundShape& compoundOf(const btCollisionShape& shape) {
    return static_cast<const btCompoundShape&>(shape);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
