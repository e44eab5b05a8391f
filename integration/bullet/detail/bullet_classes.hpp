// SPDX-License-Identifier: Zlib
#pragma once

// Of which of Bullet's classes an object is that Bullet knows by a base alone. Asked by dynamic_cast, which a
// Bullet that was compiled without RTTI does not link with: there nothing is known.

#include <integration/bullet/precision.hpp>

class btActionInterface;
class btCollisionAlgorithm;
class btCollisionDispatcher;
class btCollisionObject;
class btConstraintSolver;
class btDiscreteDynamicsWorld;
class btDispatcher;
class btKinematicCharacterController;
class btPairCachingGhostObject;
class btSequentialImpulseConstraintSolver;
class btTypedConstraint;

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Null where it is another one, or nothing is known of it.
[[nodiscard]] btKinematicCharacterController* asCharacter(btActionInterface* action);
[[nodiscard]] btPairCachingGhostObject* asPairCachingGhost(btCollisionObject* ghost);

/// Where nothing is known, what it says of itself is believed.
[[nodiscard]] btSequentialImpulseConstraintSolver* asSequentialImpulseSolver(
    btConstraintSolver* solver);

[[nodiscard]] btCollisionDispatcher* asCollisionDispatcher(btDispatcher* dispatcher);

/// Which kind of algorithm Bullet's default configuration makes for two shapes.
enum class AlgorithmKind { leaf, compound, twoCompounds };

/// Whether it is one of these, for such shapes. Where nothing is known, it is believed to be.
[[nodiscard]] bool isOfKind(const btCollisionAlgorithm& algorithm, AlgorithmKind kind);

/// Whether it has multibodies.
[[nodiscard]] bool hasMultiBodies(btDiscreteDynamicsWorld& world);

/// Whether it is a btHingeAccumulatedAngleConstraint.
[[nodiscard]] bool countsAngles(btTypedConstraint& joint);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
