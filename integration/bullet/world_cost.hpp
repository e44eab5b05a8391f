// SPDX-License-Identifier: Zlib
#pragma once

// Counts the work in the last step of a Bullet world.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Counts of one step. If the effect in parentheses (world_effects.hpp) is off, the count is exactly 0, except for
/// contacts between multibodies. This holds if the program does not change settings that a WorldConfigurator has set.
struct WorldCost {
    int pairCount = 0;             ///< overlapping pairs (effect: pairs)
    int manifoldCount = 0;         ///< contact manifolds of the narrow phase (effect: pairs)
    int contactCount = 0;          ///< contact points (effect: pairs)
    int answeredContactCount = 0;  ///< contact points handled by the solver (effect: response)
    int rubbingContactCount = 0;   ///< handled contact points with friction (effect: friction)
    int sweptCount = 0;            ///< bodies that Bullet swept (effect: sweep)
    int sleepingCount = 0;         ///< dynamic bodies that sleep (effect: sleeping)
    int turningCount = 0;          ///< dynamic bodies with an angular velocity (effect: rotation)
    int awakeCount = 0;            ///< dynamic bodies neither asleep nor in DISABLE_SIMULATION
};

/// Returns the counts of the last step. Call it between two steps. Cost: one pass over all objects and contacts.
[[nodiscard]] HASHPHASE_BULLET_EXPORT WorldCost costOf(btDiscreteDynamicsWorld& world);

/// Returns whether Bullet sweeps the body if the body moves by `way` [m] in a step and m_useContinuous is set.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool isSwept(const btRigidBody& body, btScalar way);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
