// SPDX-License-Identifier: Zlib

// Programs whose steps are measured: what they take, and what is in them.

#include "program.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include <unistd.h>

namespace programs {
namespace {

// The processor's time of this thread, in milliseconds: others may be busy.
double threadMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

// Times its own steps, with a ray from each tenth body: 4,000 spheres that fly about in a box without
// weight.
PROGRAM(traffic) {
    constexpr int kCount = 4000;
    constexpr int kSteps = 150;
    Scene<> scene;
    scene.world.setGravity({0, 0, 0});
    for (int axis = 0; axis < 3; ++axis) {
        for (const btScalar side : {btScalar(1), btScalar(-1)}) {
            btVector3 normal(0, 0, 0);
            normal[axis] = side;
            scene.add(scene.things.shape<btStaticPlaneShape>(normal, btScalar(-30)), 0, {0, 0, 0});
        }
    }
    auto* sphere = scene.things.sphere(btScalar(0.5));
    for (int i = 0; i < kCount; ++i) {
        const btVector3 place(btScalar(i % 16 * 3 - 24), btScalar(i / 16 % 16 * 3 - 24),
                              btScalar(i / 256 * 3 - 24));
        btRigidBody* body = scene.add(sphere, 1, place);
        body->setLinearVelocity({btScalar(i % 13 - 6), btScalar(i % 7 - 3), btScalar(i % 11 - 5)});
        body->setActivationState(DISABLE_DEACTIVATION);
        body->setRestitution(1);
    }
    std::vector<double> times;
    for (int i = 0; i < kSteps; ++i) {
        const double begin = threadMilliseconds();
        scene.step(1);
        for (int ray = 0; ray < kCount; ray += 10) {
            const btVector3 from = scene.things.bodies[6 + ray]->getWorldTransform().getOrigin();
            isHit(scene.world, from, from + btVector3(20, 0, 0));
        }
        times.push_back(threadMilliseconds() - begin);
    }
    std::sort(times.begin(), times.end());
    std::printf("milliseconds a step: %.4f\n", times[times.size() / 2]);
}

// Works for so long, whoever else is busy.
void workFor(double milliseconds) {
    const double begin = threadMilliseconds();
    while (threadMilliseconds() < begin + milliseconds) {
    }
}

// Steps in which it has something else to do, by a callback.
void stepsWith(btInternalTickCallback callback) {
    Pile scene;
    scene.world.setInternalTickCallback(callback);
    scene.step(80);
}

// As a step does during which others have the processor, or which waits for something.
PROGRAM(waitsInSteps) {
    stepsWith([](btDynamicsWorld*, btScalar) { usleep(3000); });
}

// Waits, in a step, for another thread that works for it.
PROGRAM(worksOnThreads) {
    stepsWith([](btDynamicsWorld*, btScalar) { std::thread(workFor, 3.0).join(); });
}

// Two spheres in each place, one of which goes on to the next place, moved by hand and without dynamics: trees
// keep the pairs of many steps.
COMPARED_PROGRAM(leavesPairs) {
    constexpr int kPlaces = 200;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    btSphereShape sphere(1);
    std::vector<btCollisionObject> objects(2 * kPlaces);
    for (btCollisionObject& object : objects) {
        object.setCollisionShape(&sphere);
        world.addCollisionObject(&object);
    }
    for (int step = 0; step < 60; ++step) {
        for (int i = 0; i < 2 * kPlaces; ++i) {
            const int place = (i / 2 + i % 2 * step) % kPlaces;
            objects[i].setWorldTransform(at({btScalar(5 * place), btScalar(i % 2), 0}));
        }
        world.performDiscreteCollisionDetection();
    }
    int contacts = 0;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        contacts += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
    }
    say("contacts", contacts);
    for (btCollisionObject& object : objects) {
        world.removeCollisionObject(&object);
    }
}

// Says how long its steps are, in which it waits for a millisecond.
PROGRAM(timedSteps) {
    using Clock = std::chrono::steady_clock;
    Pile scene;
    scene.world.setInternalTickCallback([](btDynamicsWorld*, btScalar) { usleep(1000); });
    Clock::duration all{};
    for (int i = 0; i < 200; ++i) {
        const Clock::time_point begin = Clock::now();
        scene.step(1);
        all += Clock::now() - begin;
    }
    std::printf("milliseconds: %.6f\n", std::chrono::duration<double, std::milli>(all).count());
}

}  // namespace
}  // namespace programs
