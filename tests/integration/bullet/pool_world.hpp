// SPDX-License-Identifier: Zlib
#pragma once

// A world whose bodies come and go, for snapshots of it.

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_snapshot.hpp>

#include <tests/integration/bullet/snapshot_worlds.hpp>
#include <tests/support/random.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {

/// A floor, and bodies that may be in the world or not.
struct PoolWorld {
    explicit PoolWorld(PairOrder order = PairOrder::arrival, std::size_t count = 40)
        : cache(order) {
        world.addRigidBody(&floor);
        for (std::size_t i = 0; i < count; ++i) {
            btVector3 inertia(0, 0, 0);
            shapeOf(i).calculateLocalInertia(1, inertia);
            pool.push_back(std::make_unique<btRigidBody>(1, nullptr, &shapeOf(i), inertia));
            pool.back()->setUserIndex(static_cast<int>(i));
        }
    }
    ~PoolWorld() {
        while (world.getNumConstraints() > 0) {
            world.removeConstraint(world.getConstraint(0));
        }
        while (world.getNumCollisionObjects() > 0) {
            world.removeCollisionObject(world.getCollisionObjectArray()[0]);
        }
    }
    PoolWorld(const PoolWorld&) = delete;
    PoolWorld& operator=(const PoolWorld&) = delete;

    btCollisionShape& shapeOf(std::size_t i) {
        return i % 3 == 0   ? static_cast<btCollisionShape&>(ball)
               : i % 3 == 1 ? static_cast<btCollisionShape&>(box)
                            : pill;
    }
    void add(std::size_t i, const btVector3& at) {
        btRigidBody& body = *pool[i];
        body.setLinearVelocity(btVector3(0, 0, 0));
        body.setAngularVelocity(btVector3(0, 0, 0));
        body.setCenterOfMassTransform(btTransform(btQuaternion(0, 0, 0, 1), at));
        body.clearForces();
        body.forceActivationState(ACTIVE_TAG);
        body.setDeactivationTime(0);
        world.addRigidBody(&body);
    }
    [[nodiscard]] bool isIn(std::size_t i) const { return pool[i]->isInWorld(); }

    /// A frame in which bodies come and go, by the frame's number alone.
    std::uint64_t play(std::uint64_t frame) {
        Random random(frame);
        for (std::size_t i = 0; i < pool.size(); ++i) {
            if (!random.chance(0.06)) {
                continue;
            }
            const auto x = static_cast<btScalar>(random.between(-2, 2));
            const auto y = static_cast<btScalar>(random.between(1, 4));
            if (!isIn(i)) {
                add(i, btVector3(x, y, x - y));
            } else if (random.chance(0.5)) {
                world.removeRigidBody(pool[i].get());
            } else {
                world.refreshBroadphaseProxy(pool[i].get());
            }
        }
        world.stepSimulation(btScalar(1) / 60, 0);
        return wholeState(world);
    }
    std::string save(WorldSnapshot& snapshot) { return snapshot.save(world, broadphase); }
    std::string restore(const WorldSnapshot& snapshot) {
        std::vector<btCollisionObject*> out;
        for (const auto& body : pool) {
            if (!body->isInWorld()) {
                out.push_back(body.get());
            }
        }
        return snapshot.restore(world, broadphase, {.objects = out});
    }

    btBoxShape ground{btVector3(10, 1, 10)};
    btSphereShape ball{btScalar(0.5)};
    btBoxShape box{btVector3(0.4F, 0.5F, 0.6F)};
    btCapsuleShape pill{btScalar(0.3), btScalar(0.5)};
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    PairCache cache;
    SpatialHashBroadphase broadphase{&cache};
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btRigidBody floor{0, nullptr, &ground};
    std::vector<std::unique_ptr<btRigidBody>> pool;
};

/// A world with a few bodies in it, after some steps.
struct FewBodies : PoolWorld {
    FewBodies() {
        for (std::size_t i = 0; i < 6; ++i) {
            add(i, btVector3(0, static_cast<btScalar>(i) + 1, 0));
        }
        for (int i = 0; i < 40; ++i) {
            world.stepSimulation(btScalar(1) / 60, 0);
        }
    }
    std::string restoreWithout(const WorldSnapshot& snapshot, const Returned& returned = {}) {
        return snapshot.restore(world, broadphase, returned);
    }
};

}  // namespace hashphase::test
