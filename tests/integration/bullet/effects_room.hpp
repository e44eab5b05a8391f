// SPDX-License-Identifier: Zlib
#pragma once

// A room where a WorldConfigurator is tried.

#include <tests/integration/bullet/dynamics.hpp>

#include <integration/bullet/world_cost.hpp>
#include <integration/bullet/world_effects.hpp>

#include <memory>
#include <utility>

namespace hashphase::test {

inline constexpr auto kSixtieth = btScalar(1) / 60;

/// About the z axis.
inline btQuaternion tilted(btScalar angle) {
    return btQuaternion(btVector3(0, 0, 1), angle);
}

/// A floor, body 0, and what is put on it.
struct EffectsRoom : DynamicsWorld {
    explicit EffectsRoom(std::unique_ptr<btBroadphaseInterface> broadphase =
                             std::make_unique<SpatialHashBroadphase>(),
                         btScalar slope = 0)
        : DynamicsWorld(std::move(broadphase)) {
        addTilted({50, 1, 50}, 0, placeAt({0, 0, 0}, tilted(slope)) * btVector3(0, -1, 0), slope);
    }

    btRigidBody& addTilted(const btVector3& halfExtents, btScalar mass, const btVector3& place,
                           btScalar angle) {
        return body(add(keep(std::make_unique<btBoxShape>(halfExtents)), mass,
                        placeAt(place, tilted(angle))));
    }
    btRigidBody& addCube(const btVector3& place) {
        return addBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1, place);
    }
    btRigidBody& addBall(const btVector3& place, const btVector3& velocity) {
        auto* const shape = keep(std::make_unique<btSphereShape>(btScalar(0.1)));
        btRigidBody& ball = body(add(shape, 1, placeAt(place)));
        ball.setLinearVelocity(velocity);
        return ball;
    }
    WorldCost cost() { return costOf(world()); }
};

/// So many steps of what is declared.
inline void run(WorldConfigurator& configurator, int steps) {
    for (int i = 0; i < steps; ++i) {
        configurator.step(kSixtieth);
    }
}

inline const btVector3& whereIs(const btRigidBody& body) {
    return body.getWorldTransform().getOrigin();
}

}  // namespace hashphase::test
