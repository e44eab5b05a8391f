// SPDX-License-Identifier: Zlib
#pragma once

// A room where a WorldConfigurator is tried.

#include <tests/integration/bullet/dynamics.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_cost.hpp>
#include <integration/bullet/world_effects.hpp>

#include <memory>
#include <utility>

namespace hashphase::test {

inline constexpr auto kSixtieth = btScalar(1) / 60;

inline btTransform upAt(const btVector3& place, btScalar tilt = 0) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), tilt), place);
}

/// A world whose trajectories depend on its pairs alone, as in trajectories_test.cpp.
inline std::unique_ptr<DynamicsWorld> canonicalHashWorld() {
    auto cache =
        std::make_unique<PairCache>(PairOrder::canonical, [](const btBroadphaseProxy& proxy) {
            return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
        });
    PairCache* const given = cache.get();
    return std::make_unique<DynamicsWorld>(std::make_unique<SpatialHashBroadphase>(given),
                                           std::move(cache));
}

/// A floor, body 0, and what is put on it.
struct EffectsRoom {
    explicit EffectsRoom(btScalar slope = 0) : scene(canonicalHashWorld()) {
        add(btVector3(50, 1, 50), 0, upAt(upAt({0, 0, 0}, slope) * btVector3(0, -1, 0), slope));
    }
    explicit EffectsRoom(std::unique_ptr<btBroadphaseInterface> broadphase)
        : scene(std::make_unique<DynamicsWorld>(std::move(broadphase))) {
        add(btVector3(50, 1, 50), 0, upAt({0, -1, 0}));
    }

    btRigidBody& add(const btVector3& halfExtents, btScalar mass, const btTransform& place) {
        return scene->body(
            scene->add(scene->keep(std::make_unique<btBoxShape>(halfExtents)), mass, place));
    }
    btRigidBody& addCube(const btVector3& place) {
        return add({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1, upAt(place));
    }
    btRigidBody& addBall(const btVector3& place, const btVector3& velocity) {
        auto* const shape = scene->keep(std::make_unique<btSphereShape>(btScalar(0.1)));
        btRigidBody& ball = scene->body(scene->add(shape, 1, upAt(place)));
        ball.setLinearVelocity(velocity);
        return ball;
    }
    btDiscreteDynamicsWorld& world() { return scene->world(); }
    WorldCost cost() { return costOf(scene->world()); }

    std::unique_ptr<DynamicsWorld> scene;
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
