// SPDX-License-Identifier: Zlib

// All of btDbvtBroadphase once more, in place of Bullet's: a program that links Bullet as a shared library
// and has loaded this one before it constructs, uses and destroys these, by the symbols of the header that
// it was compiled with. The object is Bullet's own, made by Bullet's constructor, so that each field has its
// place and what programs write there stays there; what they call is passed on, to Bullet's functions or to
// the broadphase that was put in place.

#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/stock_dbvt.hpp>
#include <demos/try/preload/stock_parts.hpp>
#include <demos/try/preload/verified_broadphase.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstring>
#include <memory>

namespace hashphase::tryout {
namespace {

// What is in place of Bullet's trees hangs where Bullet, which is not asked, lists proxies; m_pid, which
// Bullet sets to 0 and never looks at, says that it does.
// It says, too, that the trees are part of a sweep, where objects and rays are counted, if at all.
constexpr int kIsTaken = 0x68617368;
constexpr int kIsPart = 0x70617274;
constexpr int kSlot = btDbvtBroadphase::STAGECOUNT;

void setTaken(btDbvtBroadphase& object, btBroadphaseInterface* taken) noexcept {
    object.m_pid = taken != nullptr ? kIsTaken : 0;
    object.m_stageRoots[kSlot] = reinterpret_cast<btDbvtProxy*>(taken);
}

btBroadphaseInterface* takenFrom(const btDbvtBroadphase& object) noexcept {
    return object.m_pid == kIsTaken
               ? reinterpret_cast<btBroadphaseInterface*>(object.m_stageRoots[kSlot])
               : nullptr;
}

std::unique_ptr<btBroadphaseInterface> makeTaken(const btDbvtBroadphase& object,
                                                 btOverlappingPairCache* cache) {
    if (wantedBroadphase() == Broadphase::hash) {
        return std::make_unique<SpatialHashBroadphase>(cache);
    }
    return std::make_unique<VerifiedBroadphase>(object, cache);
}

bool isPart(const btDbvtBroadphase& object) noexcept {
    return object.m_pid == kIsPart;
}

// Bullet's constructor sets which functions are virtual to whatever the loader found first.
void constructStock(btDbvtBroadphase& object, btOverlappingPairCache* cache) {
    void* functions = nullptr;
    std::memcpy(&functions, static_cast<const void*>(&object), sizeof(functions));
    stockDbvt().construct(&object, cache);
    std::memcpy(static_cast<void*>(&object), &functions, sizeof(functions));
}

}  // namespace
}  // namespace hashphase::tryout

using namespace hashphase::tryout;

// Bullet's constructor makes the members anew that the compiler has made here, which hold nothing yet; its
// destructor destroys them, and something must be there for the compiler to destroy.
btDbvtBroadphase::btDbvtBroadphase(btOverlappingPairCache* paircache) {
    if (StockParts::areBeingMade()) {
        constructStock(*this, paircache);
        m_pid = kIsPart;
        return;
    }
    refuseOtherBullets();
    noteDbvts(1);
    if (wantedBroadphase() == Broadphase::stock) {
        constructStock(*this, paircache);
        return;
    }
    std::unique_ptr<btBroadphaseInterface> taken = makeTaken(*this, paircache);
    constructStock(*this, taken->getOverlappingPairCache());
    setTaken(*this, taken.release());
}

btDbvtBroadphase::~btDbvtBroadphase() {
    const std::unique_ptr<btBroadphaseInterface> taken(takenFrom(*this));
    stockDbvt().destruct(this);
    std::construct_at(&m_sets[DYNAMIC_SET]);
    std::construct_at(&m_sets[FIXED_SET]);
    std::construct_at(&m_rayTestStacks);
}

btBroadphaseProxy* btDbvtBroadphase::createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                                 int shapeType, void* userPtr,
                                                 int collisionFilterGroup, int collisionFilterMask,
                                                 btDispatcher* dispatcher) {
    noteObjects(isPart(*this) ? 0 : 1);
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        return taken->createProxy(aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                                  collisionFilterMask, dispatcher);
    }
    return stockDbvt().createProxy(this, aabbMin, aabbMax, shapeType, userPtr, collisionFilterGroup,
                                   collisionFilterMask, dispatcher);
}

void btDbvtBroadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    noteObjects(isPart(*this) ? 0 : -1);
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->destroyProxy(proxy, dispatcher);
    } else {
        stockDbvt().destroyProxy(this, proxy, dispatcher);
    }
}

void btDbvtBroadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                               const btVector3& aabbMax, btDispatcher* dispatcher) {
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->setAabb(proxy, aabbMin, aabbMax, dispatcher);
    } else {
        stockDbvt().setAabb(this, proxy, aabbMin, aabbMax, dispatcher);
    }
}

void btDbvtBroadphase::setAabbForceUpdate(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                                          const btVector3& aabbMax, btDispatcher* dispatcher) {
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->setAabb(proxy, aabbMin, aabbMax, dispatcher);
    } else {
        stockDbvt().setAabbForceUpdate(this, proxy, aabbMin, aabbMax, dispatcher);
    }
}

void btDbvtBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin,
                               btVector3& aabbMax) const {
    if (const btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->getAabb(proxy, aabbMin, aabbMax);
    } else {
        stockDbvt().getAabb(this, proxy, aabbMin, aabbMax);
    }
}

void btDbvtBroadphase::rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                               btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                               const btVector3& aabbMax) {
    if (isPart(*this)) {
        stockDbvt().rayTest(this, rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
        return;
    }
    const RayScope scope;
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->rayTest(rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    } else {
        stockDbvt().rayTest(this, rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
    }
}

void btDbvtBroadphase::aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                btBroadphaseAabbCallback& callback) {
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->aabbTest(aabbMin, aabbMax, callback);
    } else {
        stockDbvt().aabbTest(this, aabbMin, aabbMax, callback);
    }
}

void btDbvtBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
    const CalculateScope scope(*m_paircache);
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->calculateOverlappingPairs(dispatcher);
    } else {
        stockDbvt().calculateOverlappingPairs(this, dispatcher);
    }
}

btOverlappingPairCache* btDbvtBroadphase::getOverlappingPairCache() {
    return m_paircache;
}
const btOverlappingPairCache* btDbvtBroadphase::getOverlappingPairCache() const {
    return m_paircache;
}

void btDbvtBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    if (const btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->getBroadphaseAabb(aabbMin, aabbMax);
    } else {
        stockDbvt().getBroadphaseAabb(this, aabbMin, aabbMax);
    }
}

void btDbvtBroadphase::printStats() {
    stockDbvt().printStats(this);
}

void btDbvtBroadphase::resetPool(btDispatcher* dispatcher) {
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->resetPool(dispatcher);
    } else {
        stockDbvt().resetPool(this, dispatcher);
    }
}

// Parts of calculateOverlappingPairs().
void btDbvtBroadphase::collide(btDispatcher* dispatcher) {
    if (btBroadphaseInterface* taken = takenFrom(*this)) {
        taken->calculateOverlappingPairs(dispatcher);
    } else {
        stockDbvt().collide(this, dispatcher);
    }
}

void btDbvtBroadphase::performDeferredRemoval(btDispatcher* dispatcher) {
    if (takenFrom(*this) == nullptr) {
        stockDbvt().performDeferredRemoval(this, dispatcher);
    }
}

void btDbvtBroadphase::optimize() {
    if (takenFrom(*this) == nullptr) {
        stockDbvt().optimize(this);
    }
}

void btDbvtBroadphase::benchmark(btBroadphaseInterface* broadphase) {
    stockDbvt().benchmark(broadphase);
}
