// SPDX-License-Identifier: Zlib
#pragma once

// All that a Bullet world on stage is made of, in the order in which it is made, with a broadphase that can be
// replaced while the world runs.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/compare/observed_world.hpp>
#include <demos/report/profile_zones.hpp>
#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <integration/bullet/world_effects.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// What everything stands on: a plane, or the scene's first body, where that is a static slab, of which the
/// upper face is at height 0.
[[nodiscard]] bool isGround(const btRigidBody& body);

/// What a body is on stage. A shape that is neither sphere, box nor capsule is shown as the box around it.
[[nodiscard]] StageBody stageBody(const btRigidBody& body);

struct BulletWorld {
    BulletWorld(const BroadphaseKind& kind, const WorldSceneKind& scene, std::size_t objects,
                std::uint64_t seed);

    /// Simulates a frame, and returns Bullet's own profile zones of it, as profileZonesOf().
    [[nodiscard]] std::vector<ProfileZone> step();

    /// Sets what Bullet computes.
    void apply(WorldEffects effects);

    /// Of the broadphase: as it tells itself where it is ours, else as HeapMeter::bytes().
    [[nodiscard]] std::optional<std::int64_t> memoryBytes() const noexcept;

    /// Takes a body that is in the world out of it. Its joints go with it, and whoever leans on it wakes up.
    void remove(btRigidBody& body);

    /// Gives every body a proxy of a new broadphase. Bodies have the indices of proxies that they would have
    /// if all had been added in their order, and those that were removed had been then.
    void replaceBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs);

    btDefaultCollisionConfiguration configuration{roomyPools()};
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<btBroadphaseInterface> broadphase;
    ObservedWorld world;
    WorldContents contents{world};
    std::unique_ptr<WorldConfigurator> configurator;
};

}  // namespace hashphase::demos
