// SPDX-License-Identifier: Zlib
#pragma once

// Settings of SpatialHashBroadphase, and arguments of its batch calls.

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

    /// Ghost objects get their pairs at once, in createProxy() and setAabb(), as Bullet's character controller
    /// expects, if the pair cache has an internal ghost pair callback. (A cache not given as a PairCache counts as
    /// having one.) An object that is created at a ghost's place, or jumps there out of its last box, also pairs
    /// with the ghost at once. Calls with a dispatcher, such as a btCollisionWorld's, take every client that may
    /// have pairs for a btCollisionObject. Set false if clients are other objects.
    bool eagerGhosts = true;

    /// Proxies of these groups get their pairs at once, too. For code that is no ghost object and reads pairs
    /// between moves and steps. None by default: the program defines what a bit means.
    int eagerGroups = 0;

    /// A ParallelFor for setAabbs() and calculateOverlappingPairs(); empty for the caller's thread. Results are
    /// equal on any number of threads. See bullet_parallel_for.hpp and tbb_parallel_for.hpp.
    std::function<void(std::size_t count, std::size_t grain, LoopBody body)> parallelFor{};

    /// How to find the objects that a fast rigid body passes in a step; by default not at all. With
    /// m_useContinuous, Bullet's box of such a body covers start, end and all between. With a sweep, this box makes
    /// no pairs: the body sweeps along the way that Bullet predicts, and pairs exactly with the objects that it
    /// touches during the step. Queries find it by Bullet's box, extended to the end if m_useContinuous is off. A
    /// body sweeps until its next setAabb(): after you move it by hand, set its interpolation transform too. Cost:
    /// a look at the shape of each moving body.
    Sweep sweep = Sweep::none;

    /// A body is fast if it moves in a step by more than this share of the smallest edge of its box. Other bodies
    /// keep Bullet's box. Valid: 0 or more.
    btScalar fastFrom = 1;

    /// Set this if an overlap filter callback, or a pair cache other than PairCache, refuses all pairs that groups
    /// and masks refuse, as Bullet's own caches do. Then it is asked only about other pairs, and proxies that are
    /// filtered out, for example parked with a mask of 0, cost nothing. Otherwise it decides instead of groups and
    /// masks: it is asked about each two overlapping proxies, and again about a refused pair when either proxy has
    /// changed.
    bool filterRefusesMore = false;

    /// Ends a query when process() of its callback returns false. Off by default: Bullet's broadphases ignore the
    /// result, and programs return false for other reasons.
    bool stopWhenProcessReturnsFalse = false;
};

/// Returns what is wrong with fastFrom or the grid's settings, in a sentence, as configError(const GridConfig&);
/// empty if nothing is.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const SpatialHashConfig& config);

/// A proxy for createProxies(): the arguments of createProxy().
struct ProxyDefinition {
    btVector3 aabbMin{0, 0, 0};
    btVector3 aabbMax{0, 0, 0};
    void* userPtr = nullptr;
    int collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
    int collisionFilterMask = btBroadphaseProxy::AllFilter;
};

/// A ray for SpatialHashBroadphase::rayTests(): the arguments of rayTest().
struct BroadphaseRay {
    btVector3 from;
    btVector3 to;
    btBroadphaseRayCallback* callback = nullptr;
    btVector3 castMin{0, 0, 0};
    btVector3 castMax{0, 0, 0};
};

/// A ray for SpatialHashBroadphase::closestRays(): the arguments of closestRay().
struct ClosestRay {
    btVector3 from;
    btVector3 to;
    btCollisionWorld::RayResultCallback* callback = nullptr;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
