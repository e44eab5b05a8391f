// SPDX-License-Identifier: Zlib

// All of btDbvtBroadphase once more, in place of Bullet's: a program that links Bullet as a shared library
// and has loaded this one before it constructs, uses and destroys these, by the symbols of the header that
// it was compiled with. The object is Bullet's own, made by Bullet's constructor, so that each field has its
// place and what programs write there stays there; what they call is passed on, to Bullet's functions or to
// the broadphase that was put in place.

#include <demos/try/preload/recorder.hpp>
#include <demos/try/preload/stock_dbvt.hpp>

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
    return makeVerifiedBroadphase(object, cache);
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

// Calls the member of what was put in place, or else Bullet's function.
template <auto Member, class Object, class Stock, class... Arguments>
auto passOn(Object* object, Stock* stock, Arguments&&... arguments) {
    btBroadphaseInterface* taken = takenFrom(*object);
    return taken != nullptr ? (taken->*Member)(arguments...) : stock(object, arguments...);
}

}  // namespace
}  // namespace hashphase::tryout

using namespace hashphase::tryout;
using Ours = btBroadphaseInterface;

// Bullet's constructor makes the members anew that the compiler has made here, which hold nothing yet; its
// destructor destroys them, and something must be there for the compiler to destroy.
btDbvtBroadphase::btDbvtBroadphase(btOverlappingPairCache* paircache) {
    if (StockParts::areBeingMade()) {
        constructStock(*this, paircache);
        m_pid = kIsPart;
        return;
    }
    refuseOtherBullets();
    note(&Counts::dbvts);
    if (wantedBroadphase() == Broadphase::stock) {
        constructStock(*this, paircache);
        return;
    }
    std::unique_ptr<btBroadphaseInterface> taken = makeTaken(*this, paircache);
    constructStock(*this, taken->getOverlappingPairCache());
    m_pid = kIsTaken;
    m_stageRoots[kSlot] = reinterpret_cast<btDbvtProxy*>(taken.release());
}

btDbvtBroadphase::~btDbvtBroadphase() {
    const std::unique_ptr<btBroadphaseInterface> taken(takenFrom(*this));
    stockDbvt().destruct(this);
    std::construct_at(&m_sets[DYNAMIC_SET]);
    std::construct_at(&m_sets[FIXED_SET]);
    std::construct_at(&m_rayTestStacks);
}

BulletProxy btDbvtBroadphase::createProxy(Point aabbMin, Point aabbMax, int shapeType,
                                          void* userPtr, int collisionFilterGroup,
                                          int collisionFilterMask, Dispatcher dispatcher) {
    noteObjects(isPart(*this) ? 0 : 1);
    return passOn<&Ours::createProxy>(this, stockDbvt().createProxy, aabbMin, aabbMax, shapeType,
                                      userPtr, collisionFilterGroup, collisionFilterMask,
                                      dispatcher);
}

void btDbvtBroadphase::destroyProxy(BulletProxy proxy, Dispatcher dispatcher) {
    noteObjects(isPart(*this) ? 0 : -1);
    passOn<&Ours::destroyProxy>(this, stockDbvt().destroyProxy, proxy, dispatcher);
}

void btDbvtBroadphase::setAabb(BulletProxy proxy, Point aabbMin, Point aabbMax,
                               Dispatcher dispatcher) {
    passOn<&Ours::setAabb>(this, stockDbvt().setAabb, proxy, aabbMin, aabbMax, dispatcher);
}

void btDbvtBroadphase::setAabbForceUpdate(BulletProxy proxy, Point aabbMin, Point aabbMax,
                                          Dispatcher dispatcher) {
    passOn<&Ours::setAabb>(this, stockDbvt().setAabbForceUpdate, proxy, aabbMin, aabbMax,
                           dispatcher);
}

void btDbvtBroadphase::getAabb(BulletProxy proxy, btVector3& aabbMin, btVector3& aabbMax) const {
    passOn<&Ours::getAabb>(this, stockDbvt().getAabb, proxy, aabbMin, aabbMax);
}

void btDbvtBroadphase::rayTest(Point rayFrom, Point rayTo, btBroadphaseRayCallback& rayCallback,
                               Point aabbMin, Point aabbMax) {
    if (isPart(*this)) {
        stockDbvt().rayTest(this, rayFrom, rayTo, rayCallback, aabbMin, aabbMax);
        return;
    }
    const RayScope scope;
    passOn<&Ours::rayTest>(this, stockDbvt().rayTest, rayFrom, rayTo, rayCallback, aabbMin,
                           aabbMax);
}

void btDbvtBroadphase::aabbTest(Point aabbMin, Point aabbMax, btBroadphaseAabbCallback& callback) {
    passOn<&Ours::aabbTest>(this, stockDbvt().aabbTest, aabbMin, aabbMax, callback);
}

void btDbvtBroadphase::calculateOverlappingPairs(Dispatcher dispatcher) {
    const CalculateScope scope(*m_paircache);
    passOn<&Ours::calculateOverlappingPairs>(this, stockDbvt().calculateOverlappingPairs,
                                             dispatcher);
}

btOverlappingPairCache* btDbvtBroadphase::getOverlappingPairCache() {
    return m_paircache;
}
const btOverlappingPairCache* btDbvtBroadphase::getOverlappingPairCache() const {
    return m_paircache;
}

void btDbvtBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    passOn<&Ours::getBroadphaseAabb>(this, stockDbvt().getBroadphaseAabb, aabbMin, aabbMax);
}

void btDbvtBroadphase::printStats() {
    stockDbvt().printStats(this);
}

void btDbvtBroadphase::resetPool(Dispatcher dispatcher) {
    passOn<&Ours::resetPool>(this, stockDbvt().resetPool, dispatcher);
}

// Parts of calculateOverlappingPairs().
void btDbvtBroadphase::collide(Dispatcher dispatcher) {
    passOn<&Ours::calculateOverlappingPairs>(this, stockDbvt().collide, dispatcher);
}

void btDbvtBroadphase::performDeferredRemoval(Dispatcher dispatcher) {
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
