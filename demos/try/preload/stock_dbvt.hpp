// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own btDbvtBroadphase, whose symbols this library has taken: all of it, on the object that the
// program has made room for.

#include <demos/try/preload/symbol.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace hashphase::tryout {

struct StockDbvt {
    using Self = btDbvtBroadphase*;
    using Const = const btDbvtBroadphase*;
    using Proxy = btBroadphaseProxy*;
    using Point = const btVector3&;
    using Dispatcher = btDispatcher*;

    void (*construct)(Self, btOverlappingPairCache*) = Next{
        "_ZN16btDbvtBroadphaseC1EP22btOverlappingPairCache"};
    void (*destruct)(Self) = Next{"_ZN16btDbvtBroadphaseD1Ev"};
    void (*collide)(Self, Dispatcher) = Next{"_ZN16btDbvtBroadphase7collideEP12btDispatcher"};
    void (*optimize)(Self) = Next{"_ZN16btDbvtBroadphase8optimizeEv"};
    Proxy (*createProxy)(Self, Point, Point, int, void*, int, int, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase11createProxyERK9btVector3S2_iPviiP12btDispatcher"};
    void (*destroyProxy)(Self, Proxy, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase12destroyProxyEP17btBroadphaseProxyP12btDispatcher"};
    void (*setAabb)(Self, Proxy, Point, Point, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase7setAabbEP17btBroadphaseProxyRK9btVector3S4_P12btDispatcher"};
    void (*rayTest)(Self, Point, Point, btBroadphaseRayCallback&, Point, Point) = Next{
        "_ZN16btDbvtBroadphase7rayTestERK9btVector3S2_R23btBroadphaseRayCallbackS2_S2_"};
    void (*aabbTest)(Self, Point, Point, btBroadphaseAabbCallback&) = Next{
        "_ZN16btDbvtBroadphase8aabbTestERK9btVector3S2_R24btBroadphaseAabbCallback"};
    void (*getAabb)(Const, Proxy, btVector3&, btVector3&) = Next{
        "_ZNK16btDbvtBroadphase7getAabbEP17btBroadphaseProxyR9btVector3S3_"};
    void (*calculateOverlappingPairs)(Self, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase25calculateOverlappingPairsEP12btDispatcher"};
    void (*getBroadphaseAabb)(Const, btVector3&, btVector3&) = Next{
        "_ZNK16btDbvtBroadphase17getBroadphaseAabbER9btVector3S1_"};
    void (*printStats)(Self) = Next{"_ZN16btDbvtBroadphase10printStatsEv"};
    void (*resetPool)(Self, Dispatcher) = Next{"_ZN16btDbvtBroadphase9resetPoolEP12btDispatcher"};
    void (*performDeferredRemoval)(Self, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase22performDeferredRemovalEP12btDispatcher"};
    void (*setAabbForceUpdate)(Self, Proxy, Point, Point, Dispatcher) = Next{
        "_ZN16btDbvtBroadphase18setAabbForceUpdateEP17btBroadphaseProxyRK9btVector3S4_"
        "P12btDispatcher"};
    void (*benchmark)(btBroadphaseInterface*) = Next{
        "_ZN16btDbvtBroadphase9benchmarkEP21btBroadphaseInterface"};
};

[[nodiscard]] inline const StockDbvt& stockDbvt() {
    static const StockDbvt functions;
    return functions;
}

}  // namespace hashphase::tryout
