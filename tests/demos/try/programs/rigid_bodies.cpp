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

// Bodies of all shapes fall into a heap: where they end is chaos, that they stay in the pit is not.
COMPARED_PROGRAM(pile) {
    Scene<> scene;
    scene.addGround();
    auto* wall = scene.things.box(1, 5, 6);
    auto* side = scene.things.box(6, 5, 1);
    for (const int sign : {-1, 1}) {
        scene.add(wall, 0, {btScalar(sign * 6), 5, 0});
        scene.add(side, 0, {0, 5, btScalar(sign * 6)});
    }
    btCollisionShape* const shapes[] = {
        scene.things.box(0.4, 0.4, 0.4), scene.things.sphere(btScalar(0.5)),
        scene.things.shape<btCapsuleShape>(btScalar(0.3), btScalar(0.6)),
        scene.things.shape<btCylinderShape>(btVector3(0.4, 0.5, 0.4))};
    for (int i = 0; i < 200; ++i) {
        scene.add(
            shapes[i % 4], 1,
            {btScalar(i % 5 - 2) * btScalar(1.1), btScalar(1 + i / 25), btScalar(i / 5 % 5 - 2)});
    }
    scene.step(200);
    say("in the pit", scene.things.countNear({0, 2, 0}, 8) - 4);
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

COMPARED_PROGRAM(hingedDoor) {
    Scene<> scene;
    btRigidBody* post = scene.add(scene.things.box(0.1, 2, 0.1), 0, {0, 2, 0});
    btRigidBody* door = scene.add(scene.things.box(1, 2, 0.1), 5, {1.2, 2, 0});
    btHingeConstraint hinge(*post, *door, {0, 0, 0}, {-1.2, 0, 0}, {0, 1, 0}, {0, 1, 0});
    hinge.enableAngularMotor(true, 1, 10);
    scene.world.addConstraint(&hinge, true);
    scene.step(60);
    say("angle", hinge.getHingeAngle());
    say("distance", door->getWorldTransform().getOrigin().distance({0, 2, 0}));
    scene.world.removeConstraint(&hinge);
}

COMPARED_PROGRAM(spheresOnTerrain) {
    Scene<> scene;
    btTriangleMesh mesh;
    const auto corner = [](int x, int z) {
        return btVector3(btScalar(x * 2), btScalar((x - 10) * (x - 10) + (z - 10) * (z - 10)) / 50,
                         btScalar(z * 2));
    };
    for (int x = 0; x < 20; ++x) {
        for (int z = 0; z < 20; ++z) {
            mesh.addTriangle(corner(x, z), corner(x, z + 1), corner(x + 1, z));
            mesh.addTriangle(corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1));
        }
    }
    btBvhTriangleMeshShape bowl(&mesh, true);
    scene.add(&bowl, 0, {0, 0, 0});
    auto* sphere = scene.things.sphere(btScalar(0.5));
    for (int i = 0; i < 36; ++i) {
        scene.add(sphere, 1, {btScalar(10 + i % 6 * 4), 9, btScalar(10 + i / 6 * 4)});
    }
    scene.step(240);
    say("in the bowl", scene.things.countNear({20, 3, 20}, 15));
}

COMPARED_PROGRAM(bulletsWithCcd) {
    Scene<> scene;
    scene.world.setGravity({0, 0, 0});
    scene.add(scene.things.box(0.05, 20, 20), 0, {10, 0, 0});
    auto* shot = scene.things.sphere(btScalar(0.1));
    for (int i = 0; i < 20; ++i) {
        btRigidBody* body = scene.add(shot, 1, {0, btScalar(i - 10), btScalar(i % 3)});
        body->setLinearVelocity({300, 0, 0});
        body->setCcdMotionThreshold(btScalar(0.05));
        body->setCcdSweptSphereRadius(btScalar(0.05));
    }
    scene.step(30);
    say("through the wall", scene.things.count([](const btRigidBody& body) {
        return body.getWorldTransform().getOrigin().x() > 11;
    }));
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

// Counts, in each step, what is in a zone that bodies fall through.
COMPARED_PROGRAM(ghostZone) {
    Scene<> scene;
    btGhostPairCallback ghosts;
    scene.cache().setInternalGhostPairCallback(&ghosts);
    btBoxShape box({2, 2, 2});
    btGhostObject zone;
    zone.setCollisionShape(&box);
    zone.setWorldTransform(at({0, 10, 0}));
    zone.setCollisionFlags(zone.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    scene.world.addCollisionObject(
        &zone, btBroadphaseProxy::SensorTrigger,
        btBroadphaseProxy::AllFilter & ~btBroadphaseProxy::SensorTrigger);
    auto* sphere = scene.things.sphere(btScalar(0.2));
    for (int i = 0; i < 9; ++i) {
        scene.add(sphere, 1, {btScalar(i % 3 - 1), btScalar(14 + i / 3 * 2), 0});
    }
    int most = 0;
    for (int i = 0; i < 200; ++i) {
        scene.step(1);
        most = btMax(most, zone.getNumOverlappingObjects());
    }
    say("most in the zone", most);
    say("left in the zone", zone.getNumOverlappingObjects());
    scene.world.removeCollisionObject(&zone);
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
