// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world that computes the boxes of its objects on several threads. In place of
//
//     btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, solvers, nullptr, &configuration);
//
// write
//
//     hashphase::ParallelAabbs<btDiscreteDynamicsWorldMt> world(&dispatcher, &broadphase, solvers, nullptr,
//                                                               &configuration);
//
// Threads   Those of the broadphase: SpatialHashConfig::parallelFor. Without it, and with any other
//           broadphase, the world does what World does.
// Shapes    Their getAabb() is called on several threads at the same time, for one shape as well. The shapes
//           of Bullet allow that.
// Callbacks All boxes are computed before the first one is set: what a callback of the pair cache does to an
//           object counts from the next step on.

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
    /// Does what btCollisionWorld::updateAabbs() does. Returns false, and has done nothing, where it is not
    /// to be done on several threads.
    [[nodiscard]] HASHPHASE_BULLET_EXPORT bool update(btCollisionWorld& world);

private:
    void compute(btCollisionWorld& world, int number);
    void dropSkipped(btCollisionWorld& world);

    std::vector<btBroadphaseProxy*> proxies_;  // of each object; null where its box is not set
    std::vector<btVector3> mins_;
    std::vector<btVector3> maxs_;
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE

inline namespace HASHPHASE_BULLET_NAMESPACE {

/// A World (btCollisionWorld, btDiscreteDynamicsWorld, btDiscreteDynamicsWorldMt, btSoftRigidDynamicsWorld,
/// btMultiBodyDynamicsWorld, or your own over one of these) with its constructors and all its results, whose
/// updateAabbs() hands all boxes over in one SpatialHashBroadphase::setAabbs().
template <class World>
class ParallelAabbs : public World {
    static_assert(std::is_base_of_v<btCollisionWorld, World>, "World is a world of Bullet.");
    static_assert(!std::is_base_of_v<btSimpleDynamicsWorld, World>,
                  "btSimpleDynamicsWorld has boxes of its own kind.");

public:
    using World::World;

    /// Sets the box of each object, or with setForceUpdateAllAabbs(false) of each that is active, as World
    /// does: with Bullet's contact margin, around the predicted way with m_useContinuous, and where a box is
    /// too large the object is taken out of the simulation, with Bullet's warning. Cost: a box of its shape for
    /// each object, and that of setAabbs(); 40 bytes an object (72 in double precision).
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
