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

// --- Ends ----------------------------------------------------------------------------------------

PROGRAM(failing) {
    const Pile scene(5);
    exitStatus = 3;
}

PROGRAM(crashing) {
    const Pile scene(5);
    std::abort();
}

// With bodies in its world, of which no pair was calculated.
PROGRAM(crashingEarly) {
    const Pile scene;
    std::abort();
}

// Before it has made anything.
PROGRAM(crashingAtOnce) {
    std::abort();
}

// Where the broadphase has no trees.
PROGRAM(crashesWithoutTrees) {
    const Pile scene(5);
    if (scene.broadphase.m_sets[0].m_root == nullptr) {
        std::abort();
    }
}

// Without what is to be done at an exit.
PROGRAM(exitAtOnce) {
    const Pile scene(5);
    _exit(0);
}

PROGRAM(quickExit) {
    const Pile scene(5);
    std::quick_exit(0);
}

// Steps for as long as `isWanted`, and says that it has begun.
template <class IsWanted>
void stepWhile(const IsWanted& isWanted) {
    Pile scene(1);
    std::puts("has begun");
    std::fflush(stdout);
    while (isWanted()) {
        scene.step(1);
    }
}

PROGRAM(endless) {
    stepWhile([] { return true; });
}

// Ends when it is interrupted, and says so.
PROGRAM(interruptible) {
    static volatile std::sig_atomic_t isInterrupted = 0;
    std::signal(SIGINT, [](int) { isInterrupted = 1; });
    stepWhile([] { return isInterrupted == 0; });
    std::puts("interrupted");
}

// Calculates pairs by hand as often as it steps.
PROGRAM(endlessByHand) {
    Pile scene;
    for (;;) {
        scene.world.performDiscreteCollisionDetection();
        scene.broadphase.calculateOverlappingPairs(&scene.dispatcher);
    }
}

// --- What they do to pairs -----------------------------------------------------------------------

// Relies on the class of the pair cache, which another broadphase need not have.
PROGRAM(castsCache) {
    Scene<> scene;
    const auto* cache = dynamic_cast<const btHashedOverlappingPairCache*>(&scene.cache());
    scene.step(1);
    exitStatus = cache != nullptr ? 0 : 4;
}

btBroadphaseProxy* proxyOf(const Scene<>& scene, int body) {
    return scene.things.bodies[body]->getBroadphaseHandle();
}

// Takes pairs out of the cache, and puts others into it, behind the broadphase's back.
PROGRAM(tampering) {
    Pile scene(1);
    scene.cache().removeOverlappingPair(proxyOf(scene, 1), proxyOf(scene, 6), &scene.dispatcher);
    scene.cache().addOverlappingPair(proxyOf(scene, 1), proxyOf(scene, 5));
    scene.step(1);
}

// Resets a body as many do, by taking its pairs away.
void removePairs(btOverlappingPairCache* cache) {
    Pile scene(0, cache);
    for (int i = 0; i < 5; ++i) {
        scene.step(1);
        scene.cache().removeOverlappingPairsContainingProxy(proxyOf(scene, 1), &scene.dispatcher);
    }
}

PROGRAM(removesPairs) {
    removePairs(nullptr);
}

PROGRAM(removesPairsOfItsCache) {
    btHashedOverlappingPairCache cache;
    removePairs(&cache);
}

// Has the program do something about each new pair; the first one is number 1.
struct Finder : btOverlappingPairCallback {
    using Action = std::function<void(int number, btBroadphaseProxy* a, btBroadphaseProxy* b)>;
    Finder(btOverlappingPairCache& watched, Action does) : cache(watched), action(std::move(does)) {
        cache.setInternalGhostPairCallback(this);
    }
    ~Finder() override { cache.setInternalGhostPairCallback(nullptr); }

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

    btOverlappingPairCache& cache;
    Action action;
    int count = 0;
};

// Loses the first pair while others are made, and as often as it comes back.
PROGRAM(sabotage) {
    Scene<> scene;
    std::pair<btBroadphaseProxy*, btBroadphaseProxy*> first;
    const Finder finder(scene.cache(), [&](int number, btBroadphaseProxy* a, btBroadphaseProxy* b) {
        if (number == 1) {
            first = {a, b};
        } else if (number >= 5) {
            scene.cache().removeOverlappingPair(first.first, first.second, nullptr);
        }
    });
    addPile(scene);
    scene.step(1);
}

void moveTo(btCollisionWorld& world, btRigidBody& body, const btVector3& place) {
    body.setWorldTransform(at(place));
    body.setInterpolationWorldTransform(at(place));
    world.updateSingleAabb(&body);
}

// Four boxes without weight, of which two rest in each other; then the others meet, and the callback acts.
void actOnPair(const std::function<void(Scene<>&)>& action, int times = 1) {
    Scene<> scene;
    scene.world.setGravity({0, 0, 0});
    scene.broadphase.m_deferedcollide = true;  // no pairs but in calculations
    auto* box = scene.things.unitBox();
    for (const btScalar x : {btScalar(0), btScalar(0.5), btScalar(10), btScalar(20)}) {
        scene.add(box, 1, {x, 0, 0})->setActivationState(DISABLE_SIMULATION);
    }
    scene.step(3);
    const Finder finder(scene.cache(), [&](int number, btBroadphaseProxy*, btBroadphaseProxy*) {
        if (number <= times) {
            action(scene);
        }
    });
    moveTo(scene.world, *scene.things.bodies[3], {btScalar(10.5), 0, 0});
    scene.step(3);
}

// As a broadphase would that loses pairs at rest: as often as it comes back.
PROGRAM(losesRestingPair) {
    actOnPair(
        [](Scene<>& scene) {
            scene.cache().removeOverlappingPair(proxyOf(scene, 0), proxyOf(scene, 1),
                                                &scene.dispatcher);
        },
        4);  // the last step loses it, too
}

// As a broadphase would that does not ask the filter.
PROGRAM(makesRefusedPair) {
    actOnPair([](Scene<>& scene) { proxyOf(scene, 3)->m_collisionFilterMask = 0; });
}

// Moves a body, while pairs are calculated, to where others are.
PROGRAM(movesFromCallback) {
    actOnPair([](Scene<>& scene) {
        moveTo(scene.world, *scene.things.bodies[2], {btScalar(0.25), 0, 0});
    });
}

// Casts rays while pairs are calculated, which take longer than all else.
PROGRAM(raysFromCallback) {
    actOnPair([](Scene<>& scene) {
        for (int i = 0; i < 20'000; ++i) {
            countHits(scene.world, {-30, 0, 0}, {30, 0, 0});
        }
    });
}

struct Door : btOverlapFilterCallback {
    bool isOpen = false;

    bool needBroadphaseCollision(btBroadphaseProxy* /*a*/,
                                 btBroadphaseProxy* /*b*/) const override {
        return isOpen;
    }
};

// Changes what its filter goes by without a word to the broadphase, while nothing moves.
PROGRAM(changesFilter) {
    Scene<> scene;
    Door door;
    scene.cache().setOverlapFilterCallback(&door);
    scene.world.setGravity({0, 0, 0});
    auto* box = scene.things.unitBox();
    scene.add(box, 0, {0, 0, 0});
    scene.add(box, 1, {0, btScalar(0.9), 0});
    scene.step(1);
    scene.things.bodies[1]->setActivationState(DISABLE_SIMULATION);
    scene.step(1);
    door.isOpen = true;
    scene.step(3);
    scene.cache().setOverlapFilterCallback(nullptr);
}

// --- Other broadphases ---------------------------------------------------------------------------

// Makes steps with trees alone.
PROGRAM(noStepsWithoutTrees) {
    Pile scene;
    scene.step(scene.broadphase.m_sets[0].m_root != nullptr ? 100 : 0);
}

struct DerivedSweep : btAxisSweep3 {
    DerivedSweep() : btAxisSweep3(btVector3(-100, -100, -100), btVector3(100, 100, 100)) {}
    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btAxisSweep3::calculateOverlappingPairs(dispatcher);
    }
};

PROGRAM(derivedSweep) {
    Scene<DerivedSweep> scene;
    scene.add(scene.things.box(20, 1, 20), 0, {0, -1, 0});
    scene.add(scene.things.box(1, 1, 1), 1, {0, 1, 0});
    scene.step(30);
    say("pairs", scene.cache().getNumOverlappingPairs());
}

// Rays in the world of a derived sweep, and steps in that of another broadphase.
PROGRAM(derivedSweepBeside) {
    Pile scene;
    Scene<DerivedSweep> other;
    auto* box = other.things.box(1, 1, 1);
    for (int i = 0; i < 5; ++i) {
        other.add(box, 1, {btScalar(3 * i), 0, 0});
    }
    for (int i = 0; i < 10; ++i) {
        scene.step(1);
        countHits(other.world, {-30, 0, 0}, {30, 0, 0});
    }
}

// A sweep whose functions the compiler calls directly, in the header.
PROGRAM(bareSweep) {
    btAxisSweep3 sweep({-100, -100, -100}, {100, 100, 100});
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 50; ++i) {
        const btVector3 low(btScalar(i), 0, 0);
        proxies.push_back(
            sweep.createProxy(low, low + btVector3(1.5, 1, 1), 0, nullptr, 1, -1, nullptr));
    }
    for (int i = 0; i < 50; ++i) {
        const btVector3 low(btScalar(i), btScalar(i / 2 % 2 * 3), 0);
        sweep.setAabb(proxies[i], low, low + btVector3(1.5, 1, 1), nullptr);
    }
    sweep.calculateOverlappingPairs(nullptr);
    say("pairs", sweep.getOverlappingPairCache()->getNumOverlappingPairs());
    for (btBroadphaseProxy* proxy : proxies) {
        sweep.destroyProxy(proxy, nullptr);
    }
}

// A broadphase that is none of those that are taken over.
struct SimpleScene : Scene<btSimpleBroadphase> {
    SimpleScene() { add(things.sphere(1), 1, {0, 0, 0}); }
};

PROGRAM(simpleBroadphase) {
    SimpleScene scene;
    scene.step(10);
}

// Two broadphases, one of which is none of those that are taken over.
PROGRAM(mixed) {
    Pile scene;
    SimpleScene other;
    for (int i = 0; i < 10; ++i) {
        scene.step(1);
        other.step(1);
    }
}

}  // namespace
}  // namespace programs
