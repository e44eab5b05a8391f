// SPDX-License-Identifier: Zlib
#pragma once

// Small Bullet worlds, and the `.bullet` files that Bullet makes of them.

#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/world_contents.hpp>

#include <LinearMath/btSerializer.h>

#include <string>

namespace hashphase::demos {

/// A world with nothing in it.
struct SmallWorld {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
};

/// A world with what the file holds.
struct FilledWorld : SmallWorld {
    explicit FilledWorld(const BulletWorldFile& file) { file.fill(contents); }
    WorldContents contents{world};
};

/// The bytes of a world of so many unit boxes stacked on a static one, of which the first has a name.
inline std::string serialisedWorld(int bodies) {
    SmallWorld small;
    WorldContents contents(small.world);
    auto& box = contents.addShape<btBoxShape>(btVector3(0.5F, 0.5F, 0.5F));
    for (int i = 0; i < bodies; ++i) {
        contents.addBody(box, i == 0 ? 0 : 1, btVector3(0, static_cast<btScalar>(i), 0));
    }
    btDefaultSerializer serializer;
    if (bodies > 0) {
        serializer.registerNameForPointer(contents.bodies().front().get(), "ground");
    }
    small.world.serialize(&serializer);
    return {reinterpret_cast<const char*>(serializer.getBufferPointer()),
            static_cast<std::size_t>(serializer.getCurrentBufferSize())};
}

}  // namespace hashphase::demos
