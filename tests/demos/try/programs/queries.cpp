// SPDX-License-Identifier: Zlib

#include "program.hpp"

namespace programs {
namespace {

int hitCount = 0;

// From a tick callback, in each step, at the very boxes of the moment.
COMPARED_PROGRAM(raysFromTicks) {
    Scene<> scene;
    scene.addGround();
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 25; ++i) {
        scene.add(box, 1, {btScalar(i % 5 * 3), btScalar(3 + i % 4), btScalar(i / 5 * 3)});
    }
    hitCount = 0;
    const auto castRays = [](btDynamicsWorld* world, btScalar /*timeStep*/) {
        for (int i = 0; i < 25; ++i) {
            const btVector3 from(btScalar(i % 5 * 3), 20, btScalar(i / 5 * 3));
            hitCount += countHits(*world, from, from - btVector3(0, 40, 0));
        }
    };
    scene.world.setInternalTickCallback(castRays, nullptr, true);
    scene.step(60);
    scene.world.setInternalTickCallback(castRays);
    scene.step(60);
    say("hits", hitCount);
}

// As games cast them: between the steps.
COMPARED_PROGRAM(raysBetweenSteps) {
    Scene<> scene;
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 25; ++i) {
        scene.add(box, 0, {btScalar(i % 5 * 3), 0, btScalar(i / 5 * 3)});
    }
    int hits = 0;
    for (int step = 0; step < 60; ++step) {
        scene.step(1);
        for (int i = 0; i < 50; ++i) {
            const btVector3 from(btScalar(i), 5, btScalar(step % 15));
            hits += isHit(scene.world, from, from - btVector3(0, 10, 0)) ? 1 : 0;
        }
    }
    say("hits", hits);
}

// Pairs that are calculated by hand, after each step.
COMPARED_PROGRAM(pairsByHand) {
    Scene<> scene;
    scene.addGround();
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 10; ++i) {
        scene.add(box, 1, {0, btScalar(1 + i), 0});
    }
    int hits = 0;
    for (int i = 0; i < 40; ++i) {
        scene.step(1);
        hits += isHit(scene.world, {0, 50, 0}, {0, -1, 0}) ? 1 : 0;
        scene.world.updateAabbs();
        scene.world.computeOverlappingPairs();
    }
    say("hits", hits);
}

struct CountContacts : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint& /*point*/, const btCollisionObjectWrapper* /*a*/,
                             int /*partA*/, int /*indexA*/, const btCollisionObjectWrapper* /*b*/,
                             int /*partB*/, int /*indexB*/) override {
        ++count;
        return 0;
    }
    int count = 0;
};

COMPARED_PROGRAM(contactTests) {
    Scene<> scene;
    auto* box = scene.things.box(1, 1, 1);
    for (int i = 0; i < 27; ++i) {
        scene.add(box, 0, {btScalar(i % 3 * 3), btScalar(i / 3 % 3 * 3), btScalar(i / 9 * 3)});
    }
    scene.step(1);
    btSphereShape sphere(3);
    btCollisionObject probe;
    probe.setCollisionShape(&sphere);
    probe.setWorldTransform(at({3, 3, 3}));
    CountContacts contacts;
    scene.world.contactTest(&probe, contacts);
    say("touched", contacts.count);
    btSphereShape small(btScalar(0.4));
    const btTransform from = at({btScalar(-1.2), 20, 0});  // beside the boxes, but for its width
    const btTransform to = at({btScalar(-1.2), -20, 0});
    btCollisionWorld::ClosestConvexResultCallback hit(from.getOrigin(), to.getOrigin());
    scene.world.convexSweepTest(&small, from, to, hit);
    say("swept to", 20 - 40 * hit.m_closestHitFraction);
}

struct SameColour : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        const auto* first = static_cast<btCollisionObject*>(a->m_clientObject);
        const auto* second = static_cast<btCollisionObject*>(b->m_clientObject);
        return first->getUserIndex() != second->getUserIndex();
    }
};

COMPARED_PROGRAM(filterCallback) {
    SameColour filter;
    Scene<> scene;
    scene.cache().setOverlapFilterCallback(&filter);
    scene.addGround();
    auto* sphere = scene.things.sphere(btScalar(0.5));
    for (int i = 0; i < 40; ++i) {
        scene.add(sphere, 1, {0, btScalar(1 + i), 0})->setUserIndex(1 + i % 2);
    }
    scene.step(200);
    int wrong = 0;
    for (int i = 0; i < scene.dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold* manifold = scene.dispatcher.getManifoldByIndexInternal(i);
        wrong +=
            manifold->getBody0()->getUserIndex() == manifold->getBody1()->getUserIndex() ? 1 : 0;
    }
    say("of one colour", wrong);
}

}  // namespace
}  // namespace programs
