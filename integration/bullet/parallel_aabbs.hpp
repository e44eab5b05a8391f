// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world that computes the boxes of its objects on several threads. Instead of
//
//     btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, solvers, nullptr, &configuration);
//
// write
//
//     hashphase::ParallelAabbs<btDiscreteDynamicsWorldMt> world(&dispatcher, &broadphase, solvers, nullptr,
//                                                               &configuration);
//
// Threads   Uses SpatialHashConfig::parallelFor of the broadphase. If parallelFor is empty, or the broadphase is of
//           another class, the world works like its base class.
// Shapes    getAabb() of shapes runs on several threads at the same time, even for one shape. Bullet's shapes allow
//           this.
// Callbacks All boxes are computed before the first box is set. If a callback of the pair cache moves an object, its
//           box is updated in the next step. Callbacks may add objects, and call updateAabbs().

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <LinearMath/btVector3.h>

#include <type_traits>
#include <vector>

namespace hashphase {
namespace detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Computes the boxes of a world's objects, as btCollisionWorld::updateSingleAabb() does.
class WorldAabbs {
public:
    /// Works like btCollisionWorld::updateAabbs(). If the world has no SpatialHashBroadphase with a parallelFor,
    /// returns false and does nothing.
    [[nodiscard]] HASHPHASE_BULLET_EXPORT bool update(btCollisionWorld& world);

private:
    struct Boxes {
        std::vector<btBroadphaseProxy*> proxies;  // the proxy of each box
        std::vector<btVector3> mins;
        std::vector<btVector3> maxs;
    };

    static void compute(btCollisionWorld& world, int number, Boxes& boxes);
    static void dropSkipped(btCollisionWorld& world, Boxes& boxes);

    Boxes boxes_;  // scratch; empty while update() runs
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE

inline namespace HASHPHASE_BULLET_NAMESPACE {

/// A class derived from World, with the same constructors, which simulates exactly as World does. World is
/// btCollisionWorld, btDiscreteDynamicsWorld, btDiscreteDynamicsWorldMt, btSoftRigidDynamicsWorld,
/// btMultiBodyDynamicsWorld, or your own class derived from one of these, which must not override updateAabbs().
/// ParallelAabbs overrides updateAabbs() to set all boxes with one call of SpatialHashBroadphase::setAabbs().
template <class World>
class ParallelAabbs : public World {
    static_assert(std::is_base_of_v<btCollisionWorld, World>,
                  "ParallelAabbs<World>: derive World from btCollisionWorld.");
    static_assert(!std::is_base_of_v<btSimpleDynamicsWorld, World>,
                  "ParallelAabbs<World>: btSimpleDynamicsWorld sets its boxes in its own way. Use "
                  "btDiscreteDynamicsWorld.");

public:
    using World::World;

    /// Sets the box of each object as btCollisionWorld::updateAabbs() does. After setForceUpdateAllAabbs(false), sets
    /// only the boxes of active objects. Boxes include Bullet's contact margin and, if m_useContinuous is set, the
    /// predicted path. If the box of a non-static object is too large, Bullet does not set it, calls
    /// setActivationState(DISABLE_SIMULATION), and warns through the debug drawer, once in the program. Cost:
    /// O(objects), plus setAabbs(). Memory: 40 bytes for each object (72 in double precision).
    void updateAabbs() override {
        if (!aabbs_.update(*this)) {
            World::updateAabbs();
        }
    }

private:
    detail::WorldAabbs aabbs_;
};

}  // namespace HASHPHASE_BULLET_NAMESPACE
}  // namespace hashphase
