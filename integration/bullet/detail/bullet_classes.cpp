// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/bullet_classes.hpp>

#include <broadphase/core/compiler.hpp>

#include <BulletCollision/CollisionDispatch/btBoxBoxCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexPlaneCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/CollisionDispatch/btSphereSphereCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btSphereTriangleCollisionAlgorithm.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <typeinfo>

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

// Exactly of one of these classes.
template <class... Classes>
bool isOneOf([[maybe_unused]] const btCollisionAlgorithm& algorithm) {
#if HASHPHASE_HAS_RTTI
    return !knowsItsType(algorithm) || ((typeid(algorithm) == typeid(Classes)) || ...);
#else
    return true;
#endif
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

btCollisionDispatcher* asCollisionDispatcher(btDispatcher* dispatcher) {
    return knowsItsType(*dispatcher) ? as<btCollisionDispatcher>(*dispatcher)
                                     : static_cast<btCollisionDispatcher*>(dispatcher);
}

bool isOfKind(const btCollisionAlgorithm& algorithm, AlgorithmKind kind) {
    switch (kind) {
        case AlgorithmKind::compound:
            return isOneOf<btCompoundCollisionAlgorithm>(algorithm);
        case AlgorithmKind::twoCompounds:
            return isOneOf<btCompoundCompoundCollisionAlgorithm>(algorithm);
        case AlgorithmKind::leaf:
        default:
            return isOneOf<btConvexConvexAlgorithm, btConvexConcaveCollisionAlgorithm,
                           btBoxBoxCollisionAlgorithm, btConvexPlaneCollisionAlgorithm,
                           btSphereSphereCollisionAlgorithm, btSphereTriangleCollisionAlgorithm,
                           btEmptyAlgorithm>(algorithm);
    }
}

bool hasMultiBodies(btDiscreteDynamicsWorld& world) {
    const auto* const ofMultiBodies = as<btMultiBodyDynamicsWorld>(world);
    return ofMultiBodies != nullptr && ofMultiBodies->getNumMultibodies() > 0;
}

bool countsAngles(btTypedConstraint& joint) {
    return as<btHingeAccumulatedAngleConstraint>(joint) != nullptr;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
