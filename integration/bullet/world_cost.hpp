// SPDX-License-Identifier: Zlib
#pragma once

// Counts the work in the last step of a Bullet world.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Counts of one step. The word before a colon is an effect (world_effects.hpp). If this effect is off, the count is
/// exactly 0, unless the program changes settings of a WorldConfigurator by hand.
struct WorldCost {
    int pairCount = 0;             ///< pairs: overlapping pairs
    int manifoldCount = 0;         ///< pairs: contact manifolds of the narrow phase
    int contactCount = 0;          ///< pairs: contact points
    int answeredContactCount = 0;  ///< response: contact points handled by the solver
    int rubbingContactCount = 0;   ///< friction: handled contact points with friction
    int sweptCount = 0;            ///< sweep: bodies that Bullet swept
    int sleepingCount = 0;         ///< sleeping: dynamic bodies that sleep
    int turningCount = 0;          ///< rotation: dynamic bodies with an angular velocity
    int awakeCount = 0;            ///< dynamic bodies that are neither asleep nor disabled
};

/// Returns the counts of the last step. Call it between two steps. Cost: one pass over all objects and contacts.
[[nodiscard]] HASHPHASE_BULLET_EXPORT WorldCost costOf(btDiscreteDynamicsWorld& world);

/// Returns whether Bullet sweeps the body if the body moves by `way` [m] in a step and m_useContinuous is set.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool isSwept(const btRigidBody& body, btScalar way);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
