// SPDX-License-Identifier: Zlib
#pragma once

// The settings of SpatialHashBroadphase, and the arguments of its calls for many.

#include <broadphase/grid_config.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/sweep_mode.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <LinearMath/btVector3.h>

#include <cstddef>
#include <functional>
#include <string>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Settings of the broadphase; the defaults work for any world.
struct SpatialHashConfig {
    GridConfig grid{};

    /// Ghost objects get their pairs at once, in createProxy() and setAabb(), as Bullet's character
    /// controller expects, wherever the pair cache has an internal ghost pair callback, which tells ghosts of
    /// pairs. (A cache that is not given as a PairCache counts as having one.) An object that is created
    /// where a ghost stands, or jumps there out of its last box, makes a pair with the ghost at once, too.
    /// To find ghosts, calls with a dispatcher, as those of a btCollisionWorld, take every client that may
    /// have pairs for a btCollisionObject. Set false where clients are other objects.
    bool eagerGhosts = true;

    /// Proxies of these groups get their pairs at once, too; none by default, because the program defines
    /// what a bit means. For code that reads pairs between moves and steps, and is no ghost object.
    int eagerGroups = 0;

    /// A ParallelFor for setAabbs() and calculateOverlappingPairs(); empty for the caller's thread. The result
    /// is equal on any number of threads. See bullet_parallel_for.hpp and tbb_parallel_for.hpp.
    std::function<void(std::size_t count, std::size_t grain, LoopBody body)> parallelFor{};

    /// How to find the objects that a fast rigid body passes in a step; by default not at all. With
    /// m_useContinuous, Bullet's box of such a body covers start, end, and all between their corners. With a
    /// sweep this box makes no pairs: the body sweeps along the way that Bullet has predicted, and makes
    /// pairs exactly with the objects that it touches at some time of the step. Queries find the body by
    /// Bullet's box, anywhere on its way; without m_useContinuous the box is extended to the end for that.
    /// For worlds whose clients are btCollisionObjects. A body sweeps until its next setAabb(): after moving
    /// it by hand between steps, set its interpolation transform too. Cost: a look at the shape of each body
    /// that moves.
    Sweep sweep = Sweep::none;

    /// A body is fast in a step in which it moves by more than this share of the smallest edge of its box.
    /// Other bodies keep the box that Bullet hands in. Valid: 0 or more.
    btScalar fastFrom = 1;

    /// Set this where an overlap filter callback, or a pair cache other than PairCache, refuses all pairs
    /// that groups and masks refuse, as Bullet's own caches do. Then it is asked only about the other pairs,
    /// and proxies that are parked with a mask of 0, or otherwise filtered out, cost nothing. Without it,
    /// the filter decides in place of groups and masks: it is asked about each two proxies that overlap, and
    /// again about a refused pair when one of the two has changed.
    bool filterRefusesMore = false;

    /// Ends a query when process() of its callback returns false. Off by default: Bullet's own
    /// broadphases ignore the result, and programs return false for other reasons.
    bool stopWhenProcessReturnsFalse = false;
};

/// Says what is wrong with the grid's settings or fastFrom, as configError(const GridConfig&); empty when all
/// is well.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const SpatialHashConfig& config);

/// A proxy for createProxies(): the arguments of createProxy().
struct ProxyDefinition {
    btVector3 aabbMin{0, 0, 0};
    btVector3 aabbMax{0, 0, 0};
    void* userPtr = nullptr;
    int collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
    int collisionFilterMask = btBroadphaseProxy::AllFilter;
};

/// A ray of SpatialHashBroadphase::rayTests(), with the arguments of rayTest().
struct BroadphaseRay {
    btVector3 from;
    btVector3 to;
    btBroadphaseRayCallback* callback = nullptr;
    btVector3 castMin{0, 0, 0};
    btVector3 castMax{0, 0, 0};
};

/// A ray of SpatialHashBroadphase::closestRays(), with the arguments of closestRay().
struct ClosestRay {
    btVector3 from;
    btVector3 to;
    btCollisionWorld::RayResultCallback* callback = nullptr;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
