// SPDX-License-Identifier: Zlib

// All ways to have one of Bullet's broadphases.

#include "program.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace programs {
namespace {

const btVector3 kLow(-100, -100, -100);
const btVector3 kHigh(100, 100, 100);

template <class Scene>
void dropBoxes(Scene& scene) {
    scene.add(scene.things.box(20, 1, 20), 0, {0, -1, 0});
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 48; ++i) {
        scene.add(box, 1,
                  {btScalar(i % 4 * 2 - 4), btScalar(1 + i / 16 * 2), btScalar(i / 4 % 4 * 2 - 4)});
    }
    scene.step(150);
    btVector3 sum(0, 0, 0);
    for (const auto& body : scene.things.bodies) {
        sum += body->getWorldTransform().getOrigin();
    }
    say("sum of heights", sum.y());
    btVector3 low;
    btVector3 high;
    scene.broadphase.getBroadphaseAabb(low, high);
    say("world has a size", high.x() > low.x() ? 1 : 0);
}

COMPARED_PROGRAM(sweep16) {
    Scene<btAxisSweep3> scene(kLow, kHigh);
    dropBoxes(scene);
    say("ray", isHit(scene.world, {0, 50, 0}, {0, -50, 0}) ? 1 : 0);
}

COMPARED_PROGRAM(sweep32) {
    Scene<bt32BitAxisSweep3> scene(kLow, kHigh, 1000);
    dropBoxes(scene);
}

COMPARED_PROGRAM(sweepWithoutTrees) {
    btHashedOverlappingPairCache cache;
    Scene<btAxisSweep3> scene(kLow, kHigh, static_cast<unsigned short>(1000), &cache, true);
    dropBoxes(scene);
    say("pairs are in our cache", cache.getNumOverlappingPairs() > 0 ? 1 : 0);
}

// Statics whose boxes nobody sets again.
COMPARED_PROGRAM(sweepAtRest) {
    Scene<btAxisSweep3> scene(kLow, kHigh);
    scene.world.setForceUpdateAllAabbs(false);
    dropBoxes(scene);
}

COMPARED_PROGRAM(sortedCache) {
    btSortedOverlappingPairCache cache;
    Scene<> scene(&cache);
    dropBoxes(scene);
    say("pairs are in our cache", cache.getNumOverlappingPairs() > 0 ? 1 : 0);
}

COMPARED_PROGRAM(fieldsWritten) {
    gDbvtMargin = 0;
    Scene<> scene;
    scene.broadphase.m_deferedcollide = true;
    scene.broadphase.setVelocityPrediction(btScalar(0.25));
    dropBoxes(scene);
    say("deferred", scene.broadphase.m_deferedcollide ? 1 : 0);
    say("prediction", scene.broadphase.getVelocityPrediction());
    scene.broadphase.optimize();
    scene.step(10);
}

struct CountingBroadphase : btDbvtBroadphase {
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override {
        ++setCount;
        btDbvtBroadphase::setAabb(proxy, aabbMin, aabbMax, dispatcher);
    }
    int setCount = 0;
};

COMPARED_PROGRAM(derivedBroadphase) {
    Scene<CountingBroadphase> scene;
    dropBoxes(scene);
    say("boxes set", scene.broadphase.setCount);
}

// Without a world.
COMPARED_PROGRAM(bareBroadphase) {
    btDbvtBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
    int clients[100] = {};
    for (int i = 0; i < 100; ++i) {
        const btVector3 low(btScalar(i), 0, 0);
        proxies.push_back(broadphase.createProxy(low, low + btVector3(1.5, 1, 1),
                                                 BOX_SHAPE_PROXYTYPE, &clients[i], 1, -1, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    say("pairs in a row", broadphase.getOverlappingPairCache()->getNumOverlappingPairs());
    for (int step = 0; step < 50; ++step) {
        for (int i = 0; i < 100; i += 2) {
            const btVector3 low(btScalar(i), btScalar(step), 0);
            broadphase.setAabbForceUpdate(proxies[i], low, low + btVector3(1.5, 1, 1), nullptr);
        }
        broadphase.collide(nullptr);
        broadphase.performDeferredRemoval(nullptr);
    }
    struct Count : btBroadphaseAabbCallback {
        bool process(const btBroadphaseProxy* /*proxy*/) override {
            ++count;
            return true;
        }
        int count = 0;
    } above;
    broadphase.aabbTest({0, 40, 0}, {1000, 100, 1}, above);
    say("above", above.count);
    btVector3 low;
    btVector3 high;
    broadphase.getAabb(proxies[0], low, high);
    say("height", low.y());
    for (btBroadphaseProxy* proxy : proxies) {
        broadphase.destroyProxy(proxy, nullptr);
    }
    broadphase.resetPool(nullptr);
    say("pairs left", broadphase.getOverlappingPairCache()->getNumOverlappingPairs());
    broadphase.printStats();
}

// Zones that the program watches itself.
int enteredZones = 0;
int leftZones = 0;

COMPARED_PROGRAM(ownProfiler) {
    btSetCustomEnterProfileZoneFunc([](const char* /*name*/) { ++enteredZones; });
    btSetCustomLeaveProfileZoneFunc([] { ++leftZones; });
    Scene<> scene;
    scene.add(scene.things.sphere(1), 1, {0, 0, 0});
    scene.step(60);
    say("zones are watched", enteredZones > 300 && enteredZones == leftZones ? 1 : 0);
    say("and ours", btGetCurrentLeaveProfileZoneFunc() != nullptr ? 1 : 0);
}

}  // namespace
}  // namespace programs
