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

    /// createProxy() and setAabb() of a ghost object add its pairs immediately, as Bullet's character controller
    /// expects. This needs an internal ghost pair callback, unless the cache was passed as a btOverlappingPairCache*.
    /// An object also pairs with a ghost immediately if the object is created in the ghost's box, or moves there so
    /// far that the object's new box does not touch its previous box. If a call for a proxy passes a dispatcher, as
    /// btCollisionWorld does, the client of this proxy is cast to btCollisionObject, unless the proxy's group or mask
    /// is 0. Set false if clients have other types.
    bool eagerGhosts = true;

    /// createProxy() and setAabb() of a proxy in these groups add its pairs immediately, too. For code without ghost
    /// objects that reads pairs between a move and the next step. No groups by default, because your program defines
    /// what a bit means.
    int eagerGroups = 0;

    /// A ParallelFor for setAabbs() and calculateOverlappingPairs(). If empty, both run on the caller's thread.
    /// Results do not depend on the number of threads. See bullet_parallel_for.hpp and tbb_parallel_for.hpp.
    std::function<void(std::size_t count, std::size_t grain, LoopBody body)> parallelFor{};

    /// How to find the objects that a fast rigid body passes in a step. By default, bodies do not sweep. If
    /// m_useContinuous is set, Bullet's box of a dynamic rigid body covers start, end and all between. With a sweep,
    /// this box makes no pairs if the body is fast. Instead, the body gets pairs with exactly those objects that it
    /// touches along the path that Bullet predicts. Queries test Bullet's box of the body, extended to the end of the
    /// path if m_useContinuous is off. setAabb() sets the path, from the body's world transform to its interpolation
    /// transform, until the next setAabb(). If you move a body by hand, set both transforms. Cost: setAabb() of a
    /// moving body calls getAabb() of the body's shape up to twice.
    Sweep sweep = Sweep::none;

    /// A body is fast if it moves in a step by more than `fastFrom` times the smallest edge of its shape's box. This
    /// box is taken at the start of the step, and grown by gContactBreakingThreshold on every side. Other bodies do
    /// not sweep. Valid: 0 or more.
    btScalar fastFrom = 1;

    /// Set this to true if your overlap filter callback, or your pair cache other than PairCache, refuses at least
    /// the pairs that groups and masks refuse. Bullet's own caches without a callback do. If true, the callback or
    /// cache is asked only about pairs that groups and masks accept. Other pairs, such as all pairs of a proxy with a
    /// mask of 0, are not stored. If false, the callback or cache decides instead of groups and masks. It is asked
    /// about every pair of overlapping proxies, and again about a refused pair when the box of one of its proxies
    /// changes.
    bool filterRefusesMore = false;

    /// If true, a query ends when process() of its callback returns false. Off by default: Bullet's broadphases
    /// ignore the return value, and programs return false for other reasons.
    bool stopWhenProcessReturnsFalse = false;
};

/// Returns a sentence about an invalid fastFrom or grid setting, as configError(const GridConfig&); empty if all
/// settings are valid.
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
