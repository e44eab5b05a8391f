// SPDX-License-Identifier: Zlib

// Programs that go wrong, or that cannot be taken over.

#include "program.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>

#include <unistd.h>

namespace programs {
namespace {

int failing() {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    return 3;
}

int crashing() {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    std::abort();
}

// With bodies in its world, of which no pair was calculated.
int crashingEarly() {
    Scene<> scene;
    addPile(scene);
    std::abort();
}

// Before it has made anything.
int crashingAtOnce() {
    std::abort();
}

void sayThatItHasBegun() {
    std::puts("has begun");
    std::fflush(stdout);
}

// Without what is to be done at an exit.
int exitAtOnce(void (*exits)(int)) {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    exits(0);
    return 1;
}

int endless() {
    Scene<> scene;
    addPile(scene);
    scene.step(1);
    sayThatItHasBegun();
    for (;;) {
        scene.step(1);
    }
}

// Ends when it is interrupted, and says so.
int interruptible() {
    static volatile std::sig_atomic_t isInterrupted = 0;
    std::signal(SIGINT, [](int) { isInterrupted = 1; });
    Scene<> scene;
    addPile(scene);
    scene.step(1);
    sayThatItHasBegun();
    while (isInterrupted == 0) {
        scene.step(1);
    }
    std::puts("interrupted");
    return 0;
}

// Calculates pairs by hand as often as it steps.
int endlessByHand() {
    Scene<> scene;
    addPile(scene);
    for (;;) {
        scene.world.performDiscreteCollisionDetection();
        scene.broadphase.calculateOverlappingPairs(&scene.dispatcher);
    }
}

// Relies on the class of the pair cache, which another broadphase need not have.
int castsCache() {
    Scene<> scene;
    const auto* cache = dynamic_cast<const btHashedOverlappingPairCache*>(
        scene.broadphase.getOverlappingPairCache());
    scene.step(1);
    return cache != nullptr ? 0 : 4;
}

// Takes pairs out of the cache, and puts others into it, behind the broadphase's back.
int tampering() {
    Scene<> scene;
    addPile(scene);
    btOverlappingPairCache* cache = scene.broadphase.getOverlappingPairCache();
    scene.step(1);
    btBroadphaseProxy* first = scene.things.bodies[1]->getBroadphaseHandle();
    btBroadphaseProxy* above = scene.things.bodies[6]->getBroadphaseHandle();
    btBroadphaseProxy* far = scene.things.bodies[5]->getBroadphaseHandle();
    cache->removeOverlappingPair(first, above, &scene.dispatcher);
    cache->addOverlappingPair(first, far);
    scene.step(1);
    return 0;
}

// Resets a body as many do, by taking its pairs away.
int removesPairs(btOverlappingPairCache* cache = nullptr) {
    Scene<> scene(cache);
    addPile(scene);
    for (int i = 0; i < 5; ++i) {
        scene.step(1);
        scene.broadphase.getOverlappingPairCache()->removeOverlappingPairsContainingProxy(
            scene.things.bodies[1]->getBroadphaseHandle(), &scene.dispatcher);
    }
    return 0;
}

int removesPairsOfItsCache() {
    btHashedOverlappingPairCache cache;
    return removesPairs(&cache);
}

// Has the program do something about each new pair; the first one is number 1.
struct Finder : btOverlappingPairCallback {
    using Action = std::function<void(int number, btBroadphaseProxy* a, btBroadphaseProxy* b)>;
    explicit Finder(Action does) : action(std::move(does)) {}
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        action(++count, a, b);
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* /*a*/, btBroadphaseProxy* /*b*/,
                                btDispatcher* /*dispatcher*/) override {
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                               btDispatcher* /*dispatcher*/) override {}

    Action action;
    int count = 0;
};

// Loses the first pair while others are made, and as often as it comes back.
int sabotage() {
    Scene<> scene;
    btOverlappingPairCache* cache = scene.broadphase.getOverlappingPairCache();
    std::pair<btBroadphaseProxy*, btBroadphaseProxy*> first;
    Finder finder([&](int number, btBroadphaseProxy* a, btBroadphaseProxy* b) {
        if (number == 1) {
            first = {a, b};
        } else if (number >= 5) {
            cache->removeOverlappingPair(first.first, first.second, nullptr);
        }
    });
    cache->setInternalGhostPairCallback(&finder);
    addPile(scene);
    scene.step(1);
    cache->setInternalGhostPairCallback(nullptr);
    return 0;
}

void moveTo(btCollisionWorld& world, btRigidBody& body, const btVector3& place) {
    const btTransform transform(btQuaternion::getIdentity(), place);
    body.setWorldTransform(transform);
    body.setInterpolationWorldTransform(transform);
    world.updateSingleAabb(&body);
}

// Four boxes without weight, of which two rest in each other; then the others meet, and the callback acts.
int actsOnPair(const std::function<void(Scene<>&)>& action, int times = 1) {
    Scene<> scene;
    scene.world.setGravity({0, 0, 0});
    scene.broadphase.m_deferedcollide = true;  // no pairs but in calculations
    auto* box = scene.things.shape<btBoxShape>(btVector3(0.5, 0.5, 0.5));
    for (const btScalar x : {btScalar(0), btScalar(0.5), btScalar(10), btScalar(20)}) {
        scene.add(box, 1, {x, 0, 0})->setActivationState(DISABLE_SIMULATION);
    }
    scene.step(3);
    Finder finder([&](int number, btBroadphaseProxy* /*a*/, btBroadphaseProxy* /*b*/) {
        if (number <= times) {
            action(scene);
        }
    });
    scene.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&finder);
    moveTo(scene.world, *scene.things.bodies[3], {btScalar(10.5), 0, 0});
    scene.step(3);
    scene.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    return 0;
}

// As a broadphase would that loses pairs at rest: as often as it comes back.
int losesRestingPair() {
    return actsOnPair(
        [](Scene<>& scene) {
            scene.broadphase.getOverlappingPairCache()->removeOverlappingPair(
                scene.things.bodies[0]->getBroadphaseHandle(),
                scene.things.bodies[1]->getBroadphaseHandle(), &scene.dispatcher);
        },
        4);  // the last step loses it, too
}

// As a broadphase would that does not ask the filter.
int makesRefusedPair() {
    return actsOnPair([](Scene<>& scene) {
        scene.things.bodies[3]->getBroadphaseHandle()->m_collisionFilterMask = 0;
    });
}

// Moves a body, while pairs are calculated, to where others are.
int movesFromCallback() {
    return actsOnPair([](Scene<>& scene) {
        moveTo(scene.world, *scene.things.bodies[2], {btScalar(0.25), 0, 0});
    });
}

// Casts rays while pairs are calculated, which take longer than all else.
int raysFromCallback() {
    return actsOnPair([](Scene<>& scene) {
        for (int i = 0; i < 20'000; ++i) {
            btCollisionWorld::AllHitsRayResultCallback hits({-30, 0, 0}, {30, 0, 0});
            scene.world.rayTest(hits.m_rayFromWorld, hits.m_rayToWorld, hits);
        }
    });
}

// Makes steps with trees alone.
int noStepsWithoutTrees() {
    Scene<> scene;
    addPile(scene);
    if (scene.broadphase.m_sets[0].m_root != nullptr) {
        scene.step(100);
    }
    return 0;
}

struct DerivedSweep : btAxisSweep3 {
    DerivedSweep() : btAxisSweep3(btVector3(-100, -100, -100), btVector3(100, 100, 100)) {}
    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btAxisSweep3::calculateOverlappingPairs(dispatcher);
    }
};

int derivedSweep() {
    Scene<DerivedSweep> scene;
    scene.add(scene.things.shape<btBoxShape>(btVector3(20, 1, 20)), 0, {0, -1, 0});
    scene.add(scene.things.shape<btBoxShape>(btVector3(1, 1, 1)), 1, {0, 1, 0});
    scene.step(30);
    say("pairs", scene.broadphase.getOverlappingPairCache()->getNumOverlappingPairs());
    return 0;
}

// Rays in the world of a derived sweep, and steps in that of another broadphase.
int derivedSweepBeside() {
    Scene<> scene;
    addPile(scene);
    Scene<DerivedSweep> other;
    auto* box = other.things.shape<btBoxShape>(btVector3(1, 1, 1));
    for (int i = 0; i < 5; ++i) {
        other.add(box, 1, {btScalar(3 * i), 0, 0});
    }
    for (int i = 0; i < 10; ++i) {
        scene.step(1);
        btCollisionWorld::AllHitsRayResultCallback hits({-30, 0, 0}, {30, 0, 0});
        other.world.rayTest(hits.m_rayFromWorld, hits.m_rayToWorld, hits);
    }
    return 0;
}

// A sweep whose functions the compiler calls directly, in the header.
int bareSweep() {
    btAxisSweep3 sweep({-100, -100, -100}, {100, 100, 100});
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 50; ++i) {
        const btVector3 low(btScalar(i), 0, 0);
        proxies.push_back(
            sweep.createProxy(low, low + btVector3(1.5, 1, 1), 0, nullptr, 1, -1, nullptr));
    }
    for (int i = 0; i < 50; ++i) {
        const btVector3 low(btScalar(i), btScalar(i % 2 * 3), 0);
        sweep.setAabb(proxies[i], low, low + btVector3(1.5, 1, 1), nullptr);
    }
    sweep.calculateOverlappingPairs(nullptr);
    say("pairs", sweep.getOverlappingPairCache()->getNumOverlappingPairs());
    for (btBroadphaseProxy* proxy : proxies) {
        sweep.destroyProxy(proxy, nullptr);
    }
    return 0;
}

// Crashes where the broadphase has no trees.
int crashesWithoutTrees() {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    if (scene.broadphase.m_sets[0].m_root == nullptr) {
        std::abort();
    }
    return 0;
}

struct Door : btOverlapFilterCallback {
    bool isOpen = false;

    bool needBroadphaseCollision(btBroadphaseProxy* /*a*/,
                                 btBroadphaseProxy* /*b*/) const override {
        return isOpen;
    }
};

// Changes what its filter goes by without a word to the broadphase, while nothing moves.
int changesFilter() {
    Scene<> scene;
    Door door;
    scene.world.getPairCache()->setOverlapFilterCallback(&door);
    scene.world.setGravity({0, 0, 0});
    auto* box = scene.things.shape<btBoxShape>(btVector3(0.5, 0.5, 0.5));
    scene.add(box, 0, {0, 0, 0});
    scene.add(box, 1, {0, btScalar(0.9), 0});
    scene.step(1);
    scene.things.bodies[1]->setActivationState(DISABLE_SIMULATION);
    scene.step(1);
    door.isOpen = true;
    scene.step(3);
    scene.world.getPairCache()->setOverlapFilterCallback(nullptr);
    return 0;
}

// Two broadphases, one of which is none of those that are taken over.
int mixed() {
    Scene<> scene;
    addPile(scene);
    Scene<btSimpleBroadphase> other;
    other.add(other.things.shape<btSphereShape>(btScalar(1)), 1, {0, 0, 0});
    for (int i = 0; i < 10; ++i) {
        scene.step(1);
        other.step(1);
    }
    return 0;
}

// A broadphase that is none of those that are taken over.
int simpleBroadphase() {
    Scene<btSimpleBroadphase> scene;
    scene.add(scene.things.shape<btSphereShape>(btScalar(1)), 1, {0, 0, 0});
    scene.step(10);
    return 0;
}

}  // namespace

const std::vector<Program>& misfitPrograms() {
    static const std::vector<Program> list{
        {"failing", failing},
        {"exit-at-once", [] { return exitAtOnce(_exit); }},
        {"quick-exit", [] { return exitAtOnce(std::quick_exit); }},
        {"crashing", crashing},
        {"crashing-early", crashingEarly},
        {"crashing-at-once", crashingAtOnce},
        {"endless", endless},
        {"interruptible", interruptible},
        {"endless-by-hand", endlessByHand},
        {"casts-cache", castsCache},
        {"tampering", tampering},
        {"removes-pairs", [] { return removesPairs(); }},
        {"removes-pairs-of-its-cache", removesPairsOfItsCache},
        {"sabotage", sabotage},
        {"loses-resting-pair", losesRestingPair},
        {"makes-refused-pair", makesRefusedPair},
        {"moves-from-callback", movesFromCallback},
        {"rays-from-callback", raysFromCallback},
        {"no-steps-without-trees", noStepsWithoutTrees},
        {"derived-sweep-beside", derivedSweepBeside},
        {"derived-sweep", derivedSweep},
        {"bare-sweep", bareSweep},
        {"crashes-without-trees", crashesWithoutTrees},
        {"changes-filter", changesFilter},
        {"mixed", mixed},
        {"simple-broadphase", simpleBroadphase}};
    return list;
}

}  // namespace programs
