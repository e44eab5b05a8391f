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
// Threads   SpatialHashConfig::parallelFor of the broadphase. Without it, or with any other broadphase, the world
//           does what World does.
// Shapes    Their getAabb() runs on several threads at once, also for one shape. Bullet's shapes allow this.
// Callbacks All boxes are computed before the first is set. If a callback of the pair cache changes an object, this
//           counts from the next step on.

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
    /// As btCollisionWorld::updateAabbs(). Returns false, and does nothing, if it must not use several threads.
    [[nodiscard]] HASHPHASE_BULLET_EXPORT bool update(btCollisionWorld& world);

private:
    void compute(btCollisionWorld& world, int number);
    void dropSkipped(btCollisionWorld& world);

    std::vector<btBroadphaseProxy*> proxies_;  // of each object; null if its box is not set
    std::vector<btVector3> mins_;
    std::vector<btVector3> maxs_;
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE

inline namespace HASHPHASE_BULLET_NAMESPACE {

/// A World (btCollisionWorld, btDiscreteDynamicsWorld, btDiscreteDynamicsWorldMt, btSoftRigidDynamicsWorld,
/// btMultiBodyDynamicsWorld, or your own class over one of these) with its constructors and results. updateAabbs()
/// passes all boxes to one SpatialHashBroadphase::setAabbs().
template <class World>
class ParallelAabbs : public World {
    static_assert(std::is_base_of_v<btCollisionWorld, World>,
                  "ParallelAabbs<World>: derive World from btCollisionWorld.");
    static_assert(!std::is_base_of_v<btSimpleDynamicsWorld, World>,
                  "ParallelAabbs<World>: btSimpleDynamicsWorld sets its boxes in its own way. Use "
                  "btDiscreteDynamicsWorld.");

public:
    using World::World;

    /// Sets the box of each object, or with setForceUpdateAllAabbs(false) of each active one, as World does: with
    /// Bullet's contact margin, and with m_useContinuous around the predicted way. An object with too large a box
    /// leaves the simulation, with Bullet's warning. Cost: a box for each object, and setAabbs(); 40 bytes an
    /// object (72 in double precision).
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
