// SPDX-License-Identifier: Zlib
#pragma once

// Hard worlds over our broadphase and over Bullet's, side by side.
//
// All list pairs and contacts in an order that depends on the pairs alone
// (ListOrder::canonicalByUniqueId), so that it is the sets of pairs that are compared. Those of
// btSimpleBroadphase are exact. The others list more, which have no contacts, but tie bodies
// together, which then may sleep only at the same time.

#include <demos/scenes/hard_run.hpp>

#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Ours first, then btSimpleBroadphase, btDbvtBroadphase, the same with m_deferedcollide,
/// btAxisSweep3, bt32BitAxisSweep3. The last two are told to expect a cube around the origin that
/// the world just fits into; ours sweeps where bullets are to be noticed.
[[nodiscard]] std::vector<PhysicsBroadphase> hardBroadphases(const HardWorld& world);

/// The world over each of the broadphases, for so many steps of 1/60 s. Their order is kept.
[[nodiscard]] std::vector<PhysicsOutcome> runPhysicsCase(
    const HardWorld& world, int steps, std::span<const PhysicsBroadphase> broadphases);
[[nodiscard]] std::vector<PhysicsOutcome> runPhysicsCase(const HardWorld& world, int steps);

/// What is wrong with `ours`, seen beside all outcomes of the same case, a sentence each; none:
/// - It moves every body as btSimpleBroadphase does, to the last bit, in every step; so
///   penetration, energy, and who sleeps when are the same.
/// - Its bodies sleep no later and no less than under btDbvtBroadphase.
/// - No bullet comes through a wall unnoticed, and through walls that stop bullets no more than
///   under any of the others.
[[nodiscard]] std::vector<std::string> faultsOf(const PhysicsOutcome& ours,
                                                std::span<const PhysicsOutcome> all);

}  // namespace hashphase::demos
