// SPDX-License-Identifier: Zlib
#pragma once

// Which kind of algorithm Bullet makes for two shapes, and whether one was made for shapes as they are.

#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

// As btDefaultCollisionConfiguration chooses.
[[nodiscard]] inline AlgorithmKind kindOf(const btCollisionShape& a, const btCollisionShape& b) {
    return a.isCompound() && b.isCompound()   ? AlgorithmKind::twoCompounds
           : a.isCompound() || b.isCompound() ? AlgorithmKind::compound
                                              : AlgorithmKind::leaf;
}

[[nodiscard]] inline const btCompoundShape& compoundOf(const btCollisionShape& shape) {
    return static_cast<const btCompoundShape&>(shape);
}

/// Whether the shapes, of which one is compound, or both, have the children for which it was made.
[[nodiscard]] inline bool isUpToDate(btCollisionAlgorithm& algorithm, const btCollisionShape& a,
                                     const btCollisionShape& b) {
    const btCompoundShape& compound = compoundOf(a.isCompound() ? a : b);
    auto& ofChildren = static_cast<btCompoundCollisionAlgorithm&>(algorithm);
    if (CompoundMembers::children(ofChildren).size() != compound.getNumChildShapes()) {
        return false;
    }
    if (!a.isCompound() || !b.isCompound()) {
        return CompoundMembers::revision(ofChildren) == compound.getUpdateRevision();
    }
    const auto& two = static_cast<btCompoundCompoundCollisionAlgorithm&>(algorithm);
    return two.*revealed(btCompoundCompoundCollisionAlgorithm_m_compoundShapeRevision0()) ==
               compoundOf(a).getUpdateRevision() &&
           two.*revealed(btCompoundCompoundCollisionAlgorithm_m_compoundShapeRevision1()) ==
               compoundOf(b).getUpdateRevision();
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
