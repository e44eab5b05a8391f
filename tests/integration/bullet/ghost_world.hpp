// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own ghosts, and bodies that come and go.

#include <tests/integration/bullet/bullet_scenes.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {

/// A world without gravity, with a btGhostObject and a btPairCachingGhostObject at the origin and
/// boxes in a row elsewhere, of which some come and go. The others touch, so that btDbvtBroadphase,
/// which checks a part of its pairs in a step, would not check the ghosts' for long.
struct GhostWorld {
    explicit GhostWorld(const SpatialHashConfig& config = {})
        : GhostWorld(std::make_unique<SpatialHashBroadphase>(config)) {}

    explicit GhostWorld(std::unique_ptr<btBroadphaseInterface> over) : broadphase(std::move(over)) {
        world.setGravity({0, 0, 0});
        world.getPairCache()->setInternalGhostPairCallback(&ghostCallback);
        for (btGhostObject* const object : {&ghost, static_cast<btGhostObject*>(&cachingGhost)}) {
            object->setCollisionShape(&large);
            object->setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
            world.addCollisionObject(object, btBroadphaseProxy::SensorTrigger,
                                     btBroadphaseProxy::AllFilter);
        }
        for (int i = 0; i < 30; ++i) {
            bodies.push_back(std::make_unique<btRigidBody>(1, nullptr, &small));
            bodies.back()->setActivationState(DISABLE_DEACTIVATION);
            bodies.back()->setWorldTransform(at({100 + btScalar(i) * btScalar(1.01), 0, 0}));
            world.addRigidBody(bodies.back().get());
        }
    }
    ~GhostWorld() {
        for (const auto& body : bodies) {
            world.removeRigidBody(body.get());
        }
        world.removeCollisionObject(&ghost);
        world.removeCollisionObject(&cachingGhost);
    }

    static btTransform at(const btVector3& place) {
        return btTransform(btQuaternion(0, 0, 0, 1), place);
    }

    /// Whether both are in the world, and their boxes overlap.
    static bool touches(const btCollisionObject& a, const btCollisionObject& b) {
        const btBroadphaseProxy* const p = a.getBroadphaseHandle();
        const btBroadphaseProxy* const q = b.getBroadphaseHandle();
        return p != nullptr && q != nullptr &&
               overlap({p->m_aabbMin, p->m_aabbMax}, {q->m_aabbMin, q->m_aabbMax});
    }

    /// Numbers of the bodies that a ghost lists; the other ghost is not counted.
    std::vector<int> listedBy(btGhostObject& object) const {
        std::vector<int> listed;
        for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
            if (doesList(object, *bodies[static_cast<std::size_t>(i)])) {
                listed.push_back(i);
            }
        }
        return listed;
    }

    /// Whether it lists the other ghost.
    static bool doesList(btGhostObject& object, btCollisionObject& other) {
        btAlignedObjectArray<btCollisionObject*>& all = object.getOverlappingPairs();
        return all.findLinearSearch(&other) < all.size();
    }

    std::vector<int> touching(const btCollisionObject& object) const {
        std::vector<int> touched;
        for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
            if (touches(object, *bodies[static_cast<std::size_t>(i)])) {
                touched.push_back(i);
            }
        }
        return touched;
    }

    btGhostPairCallback ghostCallback;  // outlives the world, which tells it of its end
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::unique_ptr<btBroadphaseInterface> broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, broadphase.get(), &solver, &configuration};
    btBoxShape large{btVector3(2, 2, 2)};
    btBoxShape small{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btGhostObject ghost;
    btPairCachingGhostObject cachingGhost;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

}  // namespace hashphase::test
