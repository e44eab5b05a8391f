// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own btDbvtBroadphase, whose symbols this library has taken: all of it, on the object that the
// program has made room for.

#include <demos/try/preload/symbol.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <memory>

namespace hashphase::tryout {

using BulletProxy = btBroadphaseProxy*;
using Point = const btVector3&;
using Dispatcher = btDispatcher*;

struct StockDbvt {
    using Self = btDbvtBroadphase*;
    using Const = const btDbvtBroadphase*;

    void (*construct)(Self, btOverlappingPairCache*) = Next{
        "_ZN16btDbvtBroadphaseC1EP22btOverlappingPairCache"};
    void (*destruct)(Self) = Next{"_ZN16btDbvtBroadphaseD1Ev"};
    void (*collide)(Self, Dispatcher) = Next{"_ZN16btDbvtBroadphase7collideEP12btDispatcher"};
    void (*optimize)(Self) = Next{"_ZN16btDbvtBroadphase8optimizeEv"};
    BulletProxy (*createProxy)(Self, Point, Point, int, void*, int, int, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase11createProxyERK9btVector3S2_iPviiP12btDispatcher"};
    void (*destroyProxy)(Self, BulletProxy, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase12destroyProxyEP17btBroadphaseProxyP12btDispatcher"};
    void (*setAabb)(Self, BulletProxy, Point, Point, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase7setAabbEP17btBroadphaseProxyRK9btVector3S4_P12btDispatcher"};
    void (*rayTest)(Self, Point, Point, btBroadphaseRayCallback&, Point, Point) = Next{
        "_ZN16btDbvtBroadphase7rayTestERK9btVector3S2_R23btBroadphaseRayCallbackS2_S2_"};
    void (*aabbTest)(Self, Point, Point, btBroadphaseAabbCallback&) = Next{
        "_ZN16btDbvtBroadphase8aabbTestERK9btVector3S2_R24btBroadphaseAabbCallback"};
    void (*getAabb)(Const, BulletProxy, btVector3&, btVector3&) = Next{
        "_ZNK16btDbvtBroadphase7getAabbEP17btBroadphaseProxyR9btVector3S3_"};
    void (*calculateOverlappingPairs)(Self, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase25calculateOverlappingPairsEP12btDispatcher"};
    void (*getBroadphaseAabb)(Const, btVector3&, btVector3&) = Next{
        "_ZNK16btDbvtBroadphase17getBroadphaseAabbER9btVector3S1_"};
    void (*printStats)(Self) = Next{"_ZN16btDbvtBroadphase10printStatsEv"};
    void (*resetPool)(Self, Dispatcher) = Next{"_ZN16btDbvtBroadphase9resetPoolEP12btDispatcher"};
    void (*performDeferredRemoval)(Self, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase22performDeferredRemovalEP12btDispatcher"};
    void (*setAabbForceUpdate)(Self, BulletProxy, Point, Point, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase18setAabbForceUpdateEP17btBroadphaseProxyRK9btVector3S4_"
        "P12btDispatcher"};
    void (*benchmark)(btBroadphaseInterface*) = Next{
        "_ZN16btDbvtBroadphase9benchmarkEP21btBroadphaseInterface"};
};

[[nodiscard]] inline const StockDbvt& stockDbvt() {
    static const StockDbvt functions;
    return functions;
}

/// While it lives, what its thread makes are parts of one of Bullet's own broadphases: left as they are, and
/// not counted.
class StockParts {
public:
    StockParts() noexcept { ++depth_; }
    ~StockParts() { --depth_; }
    StockParts(const StockParts&) = delete;
    StockParts& operator=(const StockParts&) = delete;

    [[nodiscard]] static bool areBeingMade() noexcept { return depth_ > 0; }

private:
    inline static thread_local int depth_ = 0;
};

/// Our broadphase with Bullet's beside it (verified_broadphase.cpp). `settings` is the program's object, whose
/// fields steer Bullet's broadphase; it outlives this one. `cache` as for SpatialHashBroadphase.
[[nodiscard]] std::unique_ptr<btBroadphaseInterface> makeVerifiedBroadphase(
    const btDbvtBroadphase& settings, btOverlappingPairCache* cache);

}  // namespace hashphase::tryout
