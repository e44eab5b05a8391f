// SPDX-License-Identifier: Zlib
#pragma once

// Worlds to be saved and gone back to, with something of everything that Bullet has; and all that a world is,
// as a number.

#include <demos/scenes/hard_worlds.hpp>
#include <demos/scenes/physics_world.hpp>
#include <tests/support/random.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <vector>

namespace hashphase::test {

/// The hard worlds, smaller; and of shapes, compounds, joints, ghosts and characters.
[[nodiscard]] std::vector<demos::HardWorld> snapshotWorlds();

/// Ours; where the world has bullets, it sweeps.
[[nodiscard]] demos::PhysicsBroadphase snapshotBroadphase(const demos::HardWorld& world);

/// Of all objects, contacts, pairs and joints, in their order: the same when all is the same to the last bit.
[[nodiscard]] std::uint64_t wholeState(btDiscreteDynamicsWorld& world);

/// Throws bodies about, wakes some, puts some to sleep, changes friction, masses and gravity.
void disturb(btDiscreteDynamicsWorld& world, Random& random);

}  // namespace hashphase::test
