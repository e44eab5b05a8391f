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
// Threads   Uses SpatialHashConfig::parallelFor of the broadphase. Without a parallelFor, or with a broadphase of
//           another class, the world works like World.
// Shapes    getAabb() of shapes runs on several threads at once, even for the same shape. Bullet's shapes allow this.
// Callbacks All boxes are computed before the first box is set. If a callback of the pair cache changes an object,
//           its box follows in the next step.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <LinearMath/btVector3.h>

#include <type_traits>
#include <vector>

namespace hashphase {
namespace detail::inline HASHPHASE_BULLET_NAMESPACE {

/// The boxes of a world's objects, as btCollisionWorld::updateSingleAabb() computes them.
class WorldAabbs {
public:
    /// As btCollisionWorld::updateAabbs(). Returns false, and does nothing, without a parallelFor in a
    /// SpatialHashBroadphase.
    [[nodiscard]] HASHPHASE_BULLET_EXPORT bool update(btCollisionWorld& world);

private:
    void compute(btCollisionWorld& world, int number);
    void dropSkipped(btCollisionWorld& world);

    std::vector<btBroadphaseProxy*> proxies_;  // one for each box that is set
    std::vector<btVector3> mins_;
    std::vector<btVector3> maxs_;
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE

inline namespace HASHPHASE_BULLET_NAMESPACE {

/// A world with the constructors and results of World: btCollisionWorld, btDiscreteDynamicsWorld,
/// btDiscreteDynamicsWorldMt, btSoftRigidDynamicsWorld, btMultiBodyDynamicsWorld, or your own class derived from one
/// of these. updateAabbs() sets all boxes by one SpatialHashBroadphase::setAabbs().
template <class World>
class ParallelAabbs : public World {
    static_assert(std::is_base_of_v<btCollisionWorld, World>,
                  "ParallelAabbs<World>: derive World from btCollisionWorld.");
    static_assert(!std::is_base_of_v<btSimpleDynamicsWorld, World>,
                  "ParallelAabbs<World>: btSimpleDynamicsWorld sets its boxes in its own way. Use "
                  "btDiscreteDynamicsWorld.");

public:
    using World::World;

    /// Sets the box of each object as World does; with setForceUpdateAllAabbs(false), only of active objects. Boxes
    /// include Bullet's contact margin, and with m_useContinuous the predicted path. If a box is too large, Bullet
    /// removes the object from the simulation, and prints a warning. Cost: a box for each object, and setAabbs().
    /// Memory: 40 bytes for each object (72 in double precision).
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
