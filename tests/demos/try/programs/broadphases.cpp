// SPDX-License-Identifier: Zlib

// All ways to have one of Bullet's broadphases.

#include "program.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace programs {
namespace {

template <class Scene>
void dropBoxes(Scene& scene) {
    scene.add(scene.things.template shape<btBoxShape>(btVector3(20, 1, 20)), 0, {0, -1, 0});
    auto* box = scene.things.template shape<btBoxShape>(btVector3(0.5, 0.5, 0.5));
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

int sweep16() {
    Scene<btAxisSweep3> scene(btVector3(-100, -100, -100), btVector3(100, 100, 100));
    dropBoxes(scene);
    btCollisionWorld::ClosestRayResultCallback ray({0, 50, 0}, {0, -50, 0});
    scene.world.rayTest({0, 50, 0}, {0, -50, 0}, ray);
    say("ray", ray.hasHit() ? 1 : 0);
    return 0;
}

int sweep32() {
    Scene<bt32BitAxisSweep3> scene(btVector3(-100, -100, -100), btVector3(100, 100, 100), 1000);
    dropBoxes(scene);
    return 0;
}

int sweepWithoutTrees() {
    btHashedOverlappingPairCache cache;
    Scene<btAxisSweep3> scene(btVector3(-100, -100, -100), btVector3(100, 100, 100),
                              static_cast<unsigned short>(1000), &cache, true);
    dropBoxes(scene);
    say("pairs are in our cache", cache.getNumOverlappingPairs() > 0 ? 1 : 0);
    return 0;
}

// Statics whose boxes nobody sets again.
int sweepAtRest() {
    Scene<btAxisSweep3> scene(btVector3(-100, -100, -100), btVector3(100, 100, 100));
    scene.world.setForceUpdateAllAabbs(false);
    dropBoxes(scene);
    return 0;
}

int ownCache() {
    btHashedOverlappingPairCache cache;
    Scene<> scene(&cache);
    dropBoxes(scene);
    say("pairs are in our cache", cache.getNumOverlappingPairs() > 0 ? 1 : 0);
    return 0;
}

int sortedCache() {
    btSortedOverlappingPairCache cache;
    Scene<> scene(&cache);
    dropBoxes(scene);
    return 0;
}

int fieldsWritten() {
    gDbvtMargin = 0;
    Scene<> scene;
    scene.broadphase.m_deferedcollide = true;
    scene.broadphase.setVelocityPrediction(btScalar(0.25));
    dropBoxes(scene);
    say("deferred", scene.broadphase.m_deferedcollide ? 1 : 0);
    say("prediction", scene.broadphase.getVelocityPrediction());
    scene.broadphase.optimize();
    scene.step(10);
    return 0;
}

struct CountingBroadphase : btDbvtBroadphase {
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override {
        ++setCount;
        btDbvtBroadphase::setAabb(proxy, aabbMin, aabbMax, dispatcher);
    }
    int setCount = 0;
};

int derivedBroadphase() {
    Scene<CountingBroadphase> scene;
    dropBoxes(scene);
    say("boxes set", scene.broadphase.setCount);
    return 0;
}

// Without a world.
int bareBroadphase() {
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
    return 0;
}

// Zones that the program watches itself.
int enteredZones = 0;
int leftZones = 0;

int ownProfiler() {
    btSetCustomEnterProfileZoneFunc([](const char* /*name*/) { ++enteredZones; });
    btSetCustomLeaveProfileZoneFunc([] { ++leftZones; });
    Scene<> scene;
    scene.add(scene.things.shape<btSphereShape>(btScalar(1)), 1, {0, 0, 0});
    scene.step(60);
    say("zones are watched", enteredZones > 300 && enteredZones == leftZones ? 1 : 0);
    const bool isOurs = btGetCurrentLeaveProfileZoneFunc() != nullptr;
    say("and ours", isOurs ? 1 : 0);
    return 0;
}

}  // namespace

const std::vector<Program>& broadphasePrograms() {
    static const std::vector<Program> list{{"sweep-16", sweep16},
                                           {"sweep-32", sweep32},
                                           {"sweep-without-trees", sweepWithoutTrees},
                                           {"sweep-at-rest", sweepAtRest},
                                           {"own-cache", ownCache},
                                           {"sorted-cache", sortedCache},
                                           {"fields-written", fieldsWritten},
                                           {"derived-broadphase", derivedBroadphase},
                                           {"bare-broadphase", bareBroadphase},
                                           {"own-profiler", ownProfiler}};
    return list;
}

}  // namespace programs
