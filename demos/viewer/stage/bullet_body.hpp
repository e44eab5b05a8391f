// SPDX-License-Identifier: Zlib
#pragma once

// What a body of Bullet's is on stage.

#include <demos/viewer/stage/stage.hpp>

#include <btBulletDynamicsCommon.h>

namespace hashphase::demos {

/// What everything stands on: a plane, or the scene's first body, where that is a static slab, of which the
/// upper face is at height 0.
[[nodiscard]] bool isGround(const btRigidBody& body);

/// A shape that is neither sphere, box nor capsule is shown as the box around it.
[[nodiscard]] StageBody stageBody(const btRigidBody& body);

}  // namespace hashphase::demos
