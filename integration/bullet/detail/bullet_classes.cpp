// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/bullet_classes.hpp>

#include <broadphase/core/compiler.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

template <class Class, class Base>
Class* as([[maybe_unused]] Base& object) {
#if HASHPHASE_HAS_RTTI
    if (knowsItsType(object)) {
        return dynamic_cast<Class*>(&object);
    }
#endif
    return nullptr;
}

}  // namespace

btKinematicCharacterController* asCharacter(btActionInterface* action) {
    return as<btKinematicCharacterController>(*action);
}

btPairCachingGhostObject* asPairCachingGhost(btCollisionObject* ghost) {
    return as<btPairCachingGhostObject>(*ghost);
}

btSequentialImpulseConstraintSolver* asSequentialImpulseSolver(btConstraintSolver* solver) {
    if (solver == nullptr || knowsItsType(*solver)) {
        return solver != nullptr ? as<btSequentialImpulseConstraintSolver>(*solver) : nullptr;
    }
    return solver->getSolverType() == BT_SEQUENTIAL_IMPULSE_SOLVER
               ? static_cast<btSequentialImpulseConstraintSolver*>(solver)
               : nullptr;
}

bool hasMultiBodies(btDiscreteDynamicsWorld& world) {
    const auto* const ofMultiBodies = as<btMultiBodyDynamicsWorld>(world);
    return ofMultiBodies != nullptr && ofMultiBodies->getNumMultibodies() > 0;
}

bool countsAngles(btTypedConstraint& joint) {
    return as<btHingeAccumulatedAngleConstraint>(joint) != nullptr;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
