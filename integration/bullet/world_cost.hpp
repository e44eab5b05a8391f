// SPDX-License-Identifier: Zlib
#pragma once

// What the last step of a Bullet world had to do.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// A number is exactly 0 while the effect named before its colon is not declared (world_effects.hpp),
/// whatever is in the world, unless the program changes by hand what a WorldConfigurator has set.
struct WorldCost {
    int pairCount = 0;             ///< pairs: boxes that overlap
    int manifoldCount = 0;         ///< pairs: pairs that the narrow phase follows
    int contactCount = 0;          ///< pairs: points where bodies touch
    int answeredContactCount = 0;  ///< response: contact points that the solver answers
    int rubbingContactCount = 0;   ///< friction: answered contact points that rub
    int sweptCount = 0;            ///< sweep: bodies that Bullet has swept along their ways
    int sleepingCount = 0;         ///< sleeping: dynamic bodies asleep
    int turningCount = 0;          ///< rotation: dynamic bodies with an angular velocity
    int awakeCount = 0;            ///< dynamic bodies that were not asleep
};

/// Reads the world as its last step has left it: call it between two steps. Cost: a look at each
/// object and each contact.
[[nodiscard]] HASHPHASE_BULLET_EXPORT WorldCost costOf(btDiscreteDynamicsWorld& world);

/// Whether Bullet sweeps the body when it moves by `way` [m] in a step, with m_useContinuous set.
[[nodiscard]] HASHPHASE_BULLET_EXPORT bool isSwept(const btRigidBody& body, btScalar way);

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
