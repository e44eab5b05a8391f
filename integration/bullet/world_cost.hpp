// SPDX-License-Identifier: Zlib
#pragma once

// Counts what the last step of a Bullet world had to do.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Counts of one step. A count is exactly 0 while the effect before its colon is not declared (world_effects.hpp),
/// unless the program changes by hand what a WorldConfigurator has set.
struct WorldCost {
    int pairCount = 0;             ///< pairs: boxes that overlap
    int manifoldCount = 0;         ///< pairs: contact manifolds of the narrow phase
    int contactCount = 0;          ///< pairs: contact points
    int answeredContactCount = 0;  ///< response: contact points that the solver handles
    int rubbingContactCount = 0;   ///< friction: such contact points with friction
    int sweptCount = 0;            ///< sweep: bodies that Bullet swept
    int sleepingCount = 0;         ///< sleeping: dynamic bodies asleep
    int turningCount = 0;          ///< rotation: dynamic bodies with an angular velocity
    int awakeCount = 0;            ///< dynamic bodies that were not asleep
};

/// Returns the counts of the last step: call it between two steps. Cost: a look at each object and each contact.
[[nodiscard]] HASHPHASE_BULLET_EXPORT WorldCost costOf(btDiscreteDynamicsWorld& world);

/// Returns whether Bullet, with m_useContinuous set, sweeps the body when it moves by `way` [m] in a step.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool isSwept(const btRigidBody& body, btScalar way);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
