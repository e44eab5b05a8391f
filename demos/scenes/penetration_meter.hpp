// SPDX-License-Identifier: Zlib
#pragma once

// How deep bodies are in one another, whatever their world's broadphase knows of it.

#include <demos/scenes/world_contents.hpp>

#include <btBulletCollisionCommon.h>

namespace hashphase::demos {

/// Compares all bodies with all, by Bullet's narrowphase in a dispatcher of its own: the world is
/// not touched, and a pair that its broadphase has lost counts like any other.
class PenetrationMeter {
public:
    /// The deepest overlap of two bodies that may collide and respond, of which one is not static
    /// [m]; 0 where none touch. Cost: the square of the number of bodies.
    [[nodiscard]] double deepest(const WorldContents& contents);

private:
    [[nodiscard]] double depthOf(const btCollisionObject& a, const btCollisionObject& b);

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
};

}  // namespace hashphase::demos
