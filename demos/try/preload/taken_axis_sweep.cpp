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
#include <demos/try/preload/stock_dbvt.hpp>
#include <demos/try/preload/symbol.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include <cstring>
#include <new>

namespace hashphase::tryout {
namespace {

/// Bullet's own sweep, watched.
template <class Sweep>
class WatchedSweep : public Sweep {
public:
    using Sweep::Sweep;

    BulletProxy createProxy(Point aabbMin, Point aabbMax, int shapeType, void* userPtr,
                            int collisionFilterGroup, int collisionFilterMask,
                            Dispatcher dispatcher) override {
        noteObjects(1);
        BulletProxy proxy =
            Sweep::createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                               collisionFilterMask, dispatcher);
        // Left as they were by the sweep, until the box is set.
        proxy->m_aabbMin = aabbMin;
        proxy->m_aabbMax = aabbMax;
        return proxy;
    }
    void destroyProxy(BulletProxy proxy, Dispatcher dispatcher) override {
        noteObjects(-1);
        Sweep::destroyProxy(proxy, dispatcher);
    }
    void calculateOverlappingPairs(Dispatcher dispatcher) override {
        const CalculateScope scope(*this->m_pairCache);
        Sweep::calculateOverlappingPairs(dispatcher);
    }
    void rayTest(Point rayFrom, Point rayTo, btBroadphaseRayCallback& rayCallback, Point aabbMin,
                 Point aabbMax) override {
        const RayScope scope;
        Sweep::rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    }
};

/// A sweep of which nothing is used but its place.
template <class Sweep>
class TakenSweep : public Sweep {
public:
    using Sweep::Sweep;

    BulletProxy createProxy(Point aabbMin, Point aabbMax, int shapeType, void* userPtr,
                            int collisionFilterGroup, int collisionFilterMask,
                            Dispatcher dispatcher) override {
        return taken().createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                                   collisionFilterMask, dispatcher);
    }
    void destroyProxy(BulletProxy proxy, Dispatcher dispatcher) override {
        taken().destroyProxy(proxy, dispatcher);
    }
    void setAabb(BulletProxy proxy, Point aabbMin, Point aabbMax, Dispatcher dispatcher) override {
        taken().setAabb(proxy, aabbMin, aabbMax, dispatcher);
    }
    void getAabb(BulletProxy proxy, btVector3& aabbMin, btVector3& aabbMax) const override {
        taken().getAabb(proxy, aabbMin, aabbMax);
    }
    void rayTest(Point rayFrom, Point rayTo, btBroadphaseRayCallback& rayCallback, Point aabbMin,
                 Point aabbMax) override {
        taken().rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    }
    void aabbTest(Point aabbMin, Point aabbMax, btBroadphaseAabbCallback& callback) override {
        taken().aabbTest(aabbMin, aabbMax, callback);
    }
    void calculateOverlappingPairs(Dispatcher dispatcher) override {
        taken().calculateOverlappingPairs(dispatcher);
    }
    void resetPool(Dispatcher dispatcher) override { taken().resetPool(dispatcher); }

    /// Puts `trees` beside the sweep, as its constructor would have, for its destructor to destroy.
    void take(btDbvtBroadphase* trees) {
        this->m_nullPairCache = new (btAlignedAlloc(sizeof(btNullPairCache), 16)) btNullPairCache();
        this->m_raycastAccelerator = trees;
    }

private:
    [[nodiscard]] btDbvtBroadphase& taken() const noexcept { return *this->m_raycastAccelerator; }
};

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
using Constructor = void(Sweep*, Point, Point, Handle, btOverlappingPairCache*, bool);

// `makeStock` is Bullet's constructor, on what else the program has called it with.
template <class Sweep, class MakeStock>
void makeWhole(Sweep& sweep, btOverlappingPairCache* cache, bool hasNoTrees,
               const MakeStock& makeStock) {
    refuseOtherBullets();
    note(&Counts::axisSweeps);
    if (wantedBroadphase() == Broadphase::stock) {
        const StockParts parts;
        makeStock(cache, hasNoTrees);
        turnInto<WatchedSweep<Sweep>>(sweep);
        return;
    }
    auto* trees = new (btAlignedAlloc(sizeof(btDbvtBroadphase), 16)) btDbvtBroadphase(cache);
    note(&Counts::dbvts, -1);  // it is none of the program's
    makeStock(trees->getOverlappingPairCache(), true);
    turnInto<TakenSweep<Sweep>>(sweep).take(trees);
}

// Of a derived class: the program's, or one that is to be a pattern.
template <class Sweep, class MakeStock>
void makeBase(Sweep& /*sweep*/, btOverlappingPairCache* cache, bool hasNoTrees,
              const MakeStock& makeStock) {
    if (!isMakingPattern) {
        refuseOtherBullets();
        noteDerivedSweep();
    }
    const StockParts parts;
    makeStock(cache, hasNoTrees);
}

}  // namespace
}  // namespace hashphase::tryout

using namespace hashphase::tryout;

// Stands in for the constructor of that mangled name.
#define HASHPHASE_SWEEP(function, Sweep, Handle, make, mangled)                                    \
    Constructor<Sweep, Handle> function asm(mangled);                                              \
    void function(Sweep* sweep, Point worldMin, Point worldMax, Handle maxHandles,                 \
                  btOverlappingPairCache* cache, bool hasNoTrees) {                                \
        static Constructor<Sweep, Handle>* const stock = Next{mangled};                            \
        make(*sweep, cache, hasNoTrees, [&](btOverlappingPairCache* used, bool isWithoutTrees) {   \
            stock(sweep, worldMin, worldMax, maxHandles, used, isWithoutTrees);                    \
        });                                                                                        \
    }

// C1 makes a whole object, C2 the base of a derived one.
extern "C" {

HASHPHASE_SWEEP(constructSweep16, btAxisSweep3, unsigned short, makeWhole,
                "_ZN12btAxisSweep3C1ERK9btVector3S2_tP22btOverlappingPairCacheb")
HASHPHASE_SWEEP(constructBaseSweep16, btAxisSweep3, unsigned short, makeBase,
                "_ZN12btAxisSweep3C2ERK9btVector3S2_tP22btOverlappingPairCacheb")
HASHPHASE_SWEEP(constructSweep32, bt32BitAxisSweep3, unsigned, makeWhole,
                "_ZN17bt32BitAxisSweep3C1ERK9btVector3S2_jP22btOverlappingPairCacheb")
HASHPHASE_SWEEP(constructBaseSweep32, bt32BitAxisSweep3, unsigned, makeBase,
                "_ZN17bt32BitAxisSweep3C2ERK9btVector3S2_jP22btOverlappingPairCacheb")
}
