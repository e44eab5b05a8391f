// SPDX-License-Identifier: Zlib

// The constructors of the two axis sweeps, in place of Bullet's. The rest of these classes is in headers,
// and therefore in the program itself; so the object is a sweep as the program knows it, made by Bullet's
// constructor, and is then given other virtual functions. A sweep has a btDbvtBroadphase beside it, for
// rays, and destroys it: where ours takes over, that one (taken_dbvt.cpp) does all the work.
//
// Not taken over are objects of derived classes, which have virtual functions of their own; and calls that
// the compiler binds to the code in the header, of a sweep that is used without a world: these find a sweep
// of the size that was asked for, and work as ever.

#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/stock_parts.hpp>
#include <demos/try/preload/symbol.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cstring>
#include <new>

namespace hashphase::tryout {
namespace {

/// Bullet's own sweep, watched.
template <class Sweep>
class WatchedSweep : public Sweep {
public:
    using Sweep::Sweep;

    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override {
        noteObjects(1);
        btBroadphaseProxy* proxy =
            Sweep::createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                               collisionFilterMask, dispatcher);
        // Left as they were by the sweep, until the box is set.
        proxy->m_aabbMin = aabbMin;
        proxy->m_aabbMax = aabbMax;
        return proxy;
    }
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override {
        noteObjects(-1);
        Sweep::destroyProxy(proxy, dispatcher);
    }
    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        const CalculateScope scope(*this->m_pairCache);
        Sweep::calculateOverlappingPairs(dispatcher);
    }
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                 const btVector3& aabbMax) override {
        const RayScope scope;
        Sweep::rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    }
};

/// A sweep of which nothing is used but its place.
template <class Sweep>
class TakenSweep : public Sweep {
public:
    using Sweep::Sweep;

    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override {
        return taken().createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                                   collisionFilterMask, dispatcher);
    }
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override {
        taken().destroyProxy(proxy, dispatcher);
    }
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override {
        taken().setAabb(proxy, aabbMin, aabbMax, dispatcher);
    }
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override {
        taken().getAabb(proxy, aabbMin, aabbMax);
    }
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                 const btVector3& aabbMax) override {
        taken().rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    }
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override {
        taken().aabbTest(aabbMin, aabbMax, callback);
    }
    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        taken().calculateOverlappingPairs(dispatcher);
    }
    void resetPool(btDispatcher* dispatcher) override { taken().resetPool(dispatcher); }

    /// Puts `trees` beside the sweep, as its constructor would have, for its destructor to destroy.
    void take(btDbvtBroadphase* trees) {
        this->m_nullPairCache = new (btAlignedAlloc(sizeof(btNullPairCache), 16)) btNullPairCache();
        this->m_raycastAccelerator = trees;
    }

private:
    [[nodiscard]] btDbvtBroadphase& taken() const noexcept { return *this->m_raycastAccelerator; }
};

btDbvtBroadphase* makeTakenTrees(btOverlappingPairCache* cache) {
    return new (btAlignedAlloc(sizeof(btDbvtBroadphase), 16)) btDbvtBroadphase(cache);
}

thread_local bool isMakingPattern = false;

// Gives `sweep` the virtual functions of a class that adds no fields to it.
template <class Derived, class Sweep>
Derived& turnInto(Sweep& sweep) {
    static_assert(sizeof(Derived) == sizeof(Sweep));
    // Never destroyed: the program may keep its broadphases to the end.
    static const Derived& pattern = []() -> const Derived& {
        isMakingPattern = true;
        const Derived* made = new Derived({0, 0, 0}, {1, 1, 1}, 2, nullptr, true);
        isMakingPattern = false;
        return *made;
    }();
    std::memcpy(static_cast<void*>(&sweep), static_cast<const void*>(&pattern), sizeof(void*));
    return static_cast<Derived&>(sweep);
}

template <class Sweep, class Handle>
using SweepConstructor = void(Sweep*, const btVector3&, const btVector3&, Handle,
                              btOverlappingPairCache*, bool);

template <class Sweep, class Handle>
void constructSweep(SweepConstructor<Sweep, Handle>* stock, Sweep* sweep, const btVector3& worldMin,
                    const btVector3& worldMax, Handle maxHandles, btOverlappingPairCache* cache,
                    bool hasNoTrees) {
    refuseOtherBullets();
    noteAxisSweep();
    if (wantedBroadphase() == Broadphase::stock) {
        const StockParts parts;
        stock(sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
        turnInto<WatchedSweep<Sweep>>(*sweep);
        return;
    }
    btDbvtBroadphase* trees = makeTakenTrees(cache);
    noteDbvts(-1);  // it is none of the program's
    stock(sweep, worldMin, worldMax, maxHandles, trees->getOverlappingPairCache(), true);
    turnInto<TakenSweep<Sweep>>(*sweep).take(trees);
}

// Of a derived class: the program's, or one that is to be a pattern.
template <class Sweep, class Handle>
void constructBaseSweep(SweepConstructor<Sweep, Handle>* stock, Sweep* sweep,
                        const btVector3& worldMin, const btVector3& worldMax, Handle maxHandles,
                        btOverlappingPairCache* cache, bool hasNoTrees) {
    if (!isMakingPattern) {
        refuseOtherBullets();
        noteDerivedSweep();
    }
    const StockParts parts;
    stock(sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
}

}  // namespace
}  // namespace hashphase::tryout

using namespace hashphase::tryout;

#define HASHPHASE_SWEEP16(kind)                                                                    \
    "_ZN12btAxisSweep3" kind "ERK9btVector3S2_tP22btOverlappingPairCacheb"
#define HASHPHASE_SWEEP32(kind)                                                                    \
    "_ZN17bt32BitAxisSweep3" kind "ERK9btVector3S2_jP22btOverlappingPairCacheb"

// C1 makes a whole object, C2 the base of a derived one.
extern "C" {

SweepConstructor<btAxisSweep3, unsigned short> constructSweep16 asm(HASHPHASE_SWEEP16("C1"));
SweepConstructor<btAxisSweep3, unsigned short> constructBaseSweep16 asm(HASHPHASE_SWEEP16("C2"));
SweepConstructor<bt32BitAxisSweep3, unsigned> constructSweep32 asm(HASHPHASE_SWEEP32("C1"));
SweepConstructor<bt32BitAxisSweep3, unsigned> constructBaseSweep32 asm(HASHPHASE_SWEEP32("C2"));

void constructSweep16(btAxisSweep3* sweep, const btVector3& worldMin, const btVector3& worldMax,
                      unsigned short maxHandles, btOverlappingPairCache* cache, bool hasNoTrees) {
    static SweepConstructor<btAxisSweep3, unsigned short>* const stock =
        Next{HASHPHASE_SWEEP16("C1")};
    constructSweep(stock, sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
}

void constructBaseSweep16(btAxisSweep3* sweep, const btVector3& worldMin, const btVector3& worldMax,
                          unsigned short maxHandles, btOverlappingPairCache* cache,
                          bool hasNoTrees) {
    static SweepConstructor<btAxisSweep3, unsigned short>* const stock =
        Next{HASHPHASE_SWEEP16("C2")};
    constructBaseSweep(stock, sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
}

void constructSweep32(bt32BitAxisSweep3* sweep, const btVector3& worldMin,
                      const btVector3& worldMax, unsigned maxHandles, btOverlappingPairCache* cache,
                      bool hasNoTrees) {
    static SweepConstructor<bt32BitAxisSweep3, unsigned>* const stock =
        Next{HASHPHASE_SWEEP32("C1")};
    constructSweep(stock, sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
}

void constructBaseSweep32(bt32BitAxisSweep3* sweep, const btVector3& worldMin,
                          const btVector3& worldMax, unsigned maxHandles,
                          btOverlappingPairCache* cache, bool hasNoTrees) {
    static SweepConstructor<bt32BitAxisSweep3, unsigned>* const stock =
        Next{HASHPHASE_SWEEP32("C2")};
    constructBaseSweep(stock, sweep, worldMin, worldMax, maxHandles, cache, hasNoTrees);
}
}
