// SPDX-License-Identifier: Zlib

#include "program.hpp"

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>

namespace programs {
namespace {

void addWall(Scene<>& scene, int width, int height) {
    auto* brick = scene.things.box(0.5, 0.25, 0.25);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            scene.add(brick, 1,
                      {btScalar(x) + (y % 2) * btScalar(0.5), btScalar(0.25 + y * 0.5), 0});
        }
    }
}

// Stands, falls asleep, and is woken by a ball.
COMPARED_PROGRAM(wall) {
    Scene<> scene;
    scene.addGround();
    addWall(scene, 5, 6);
    scene.step(240);
    say("asleep", scene.things.count([](const btRigidBody& body) {
        return body.getActivationState() == ISLAND_SLEEPING;
    }));
    btRigidBody* ball = scene.add(scene.things.sphere(btScalar(0.5)), 50, {2, 1.5, 8});
    ball->setLinearVelocity({0, 0, -30});
    scene.step(60);
    say("ball has passed", ball->getWorldTransform().getOrigin().z() < -2 ? 1 : 0);
}

COMPARED_PROGRAM(vehicle) {
    Scene<> scene;
    scene.addGround();
    btRigidBody* chassis = scene.add(scene.things.box(1, 0.5, 2), 800, {0, 1.2, 0});
    chassis->setActivationState(DISABLE_DEACTIVATION);
    btRaycastVehicle::btVehicleTuning tuning;
    btDefaultVehicleRaycaster raycaster(&scene.world);
    btRaycastVehicle car(tuning, chassis, &raycaster);
    car.setCoordinateSystem(0, 1, 2);
    scene.world.addAction(&car);
    for (const btScalar z : {btScalar(1.5), btScalar(-1.5)}) {
        for (const btScalar x : {btScalar(-1), btScalar(1)}) {
            car.addWheel({x, 0, z}, {0, -1, 0}, {-1, 0, 0}, btScalar(0.6), btScalar(0.4), tuning,
                         z > 0);
        }
    }
    for (int i = 0; i < 180; ++i) {
        car.applyEngineForce(1500, 2);
        car.applyEngineForce(1500, 3);
        scene.step(1);
    }
    say("has driven", chassis->getWorldTransform().getOrigin().z() > 5 ? 1 : 0);
    int onGround = 0;
    for (int wheel = 0; wheel < 4; ++wheel) {
        onGround += car.getWheelInfo(wheel).m_raycastInfo.m_isInContact ? 1 : 0;
    }
    say("wheels on the ground", onGround);
    scene.world.removeAction(&car);
}

COMPARED_PROGRAM(character) {
    Scene<> scene;
    btGhostPairCallback ghosts;
    scene.cache().setInternalGhostPairCallback(&ghosts);
    scene.addGround();
    scene.add(scene.things.box(1, 3, 5), 0, {6, 3, 0});
    btCapsuleShape capsule(btScalar(0.4), 1);
    btPairCachingGhostObject body;
    body.setWorldTransform(at({0, 1, 0}));
    body.setCollisionShape(&capsule);
    body.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
    btKinematicCharacterController walker(&body, &capsule, btScalar(0.35), {0, 1, 0});
    scene.world.addCollisionObject(
        &body, btBroadphaseProxy::CharacterFilter,
        btBroadphaseProxy::StaticFilter | btBroadphaseProxy::DefaultFilter);
    scene.world.addAction(&walker);
    walker.setWalkDirection({btScalar(0.1), 0, 0});
    scene.step(120);
    const btVector3& place = body.getWorldTransform().getOrigin();
    say("stopped by the wall", place.x() > 4 && place.x() < 5 ? 1 : 0);
    say("on the ground", walker.onGround() ? 1 : 0);
    say("pairs", body.getOverlappingPairCache()->getNumOverlappingPairs());
    scene.world.removeAction(&walker);
    scene.world.removeCollisionObject(&body);
}

// Calls of six sub-steps each, and some of none.
COMPARED_PROGRAM(subSteps) {
    Scene<> scene;
    addWall(scene, 5, 6);
    scene.addGround();
    int made = 0;
    for (int i = 0; i < 50; ++i) {
        made += scene.world.stepSimulation(btScalar(1) / 60, 6, btScalar(1) / 360);
        made += scene.world.stepSimulation(btScalar(1) / 10000, 6, btScalar(1) / 360);
    }
    say("sub-steps", made >= 300 ? 1 : 0);
}

COMPARED_PROGRAM(simpleWorld) {
    Scene<btDbvtBroadphase, btSimpleDynamicsWorld> scene;
    scene.add(scene.things.box(10, 1, 10), 0, {0, -1, 0});
    auto* box = scene.things.unitBox();
    for (int i = 0; i < 9; ++i) {
        scene.add(box, 1, {btScalar(i % 3 * 3 - 3), 2, btScalar(i / 3 * 3 - 3)});
    }
    scene.step(120);
    say("on the table", scene.things.count([](const btRigidBody& body) {
        return body.getWorldTransform().getOrigin().y() > btScalar(0.3);
    }));
}

}  // namespace
}  // namespace programs
