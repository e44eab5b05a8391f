// SPDX-License-Identifier: Zlib

// Soft bodies, deformables, multibodies.

#include "program.hpp"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

namespace programs {
namespace {

COMPARED_PROGRAM(cloth) {
    Scene<btDbvtBroadphase, btSoftRigidDynamicsWorld, btSoftBodyRigidBodyCollisionConfiguration>
        scene;
    btSoftRigidDynamicsWorld& world = scene.world;
    world.getWorldInfo().m_gravity.setValue(0, -10, 0);
    scene.add(scene.things.box(2, 2, 2), 0, {0, 2, 0});
    btSoftBody* sheet = btSoftBodyHelpers::CreatePatch(
        world.getWorldInfo(), {-4, 6, -4}, {4, 6, -4}, {-4, 6, 4}, {4, 6, 4}, 17, 17, 0, true);
    sheet->setTotalMass(1);
    world.addSoftBody(sheet);
    scene.step(120);
    int onTop = 0;
    for (int i = 0; i < sheet->m_nodes.size(); ++i) {
        onTop += sheet->m_nodes[i].m_x.y() > btScalar(3.5) ? 1 : 0;
    }
    say("cloth lies on the box", onTop > 20 ? 1 : 0);
    world.removeSoftBody(sheet);
    delete sheet;
}

COMPARED_PROGRAM(deformable) {
    Things things;
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btDeformableBodySolver bodySolver;
    btDeformableMultiBodyConstraintSolver solver;
    solver.setDeformableSolver(&bodySolver);
    btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration,
                                             &bodySolver);
    world.setGravity({0, -10, 0});
    world.getWorldInfo().m_gravity.setValue(0, -10, 0);
    world.getWorldInfo().m_sparsesdf.setDefaultVoxelsz(btScalar(0.25));
    world.getWorldInfo().m_sparsesdf.Reset();
    btRigidBody* ground = things.body(things.box(10, 1, 10), 0, {0, -1, 0});
    world.addRigidBody(ground);
    btSoftBody* sheet = btSoftBodyHelpers::CreatePatch(
        world.getWorldInfo(), {-2, 2, -2}, {2, 2, -2}, {-2, 2, 2}, {2, 2, 2}, 9, 9, 0, true);
    sheet->setTotalMass(1);
    sheet->m_cfg.kKHR = 1;
    sheet->m_cfg.kCHR = 1;
    sheet->m_cfg.kDF = 1;
    sheet->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    sheet->getCollisionShape()->setMargin(btScalar(0.1));
    world.addSoftBody(sheet);
    btDeformableMassSpringForce springs(10, btScalar(0.1));
    btDeformableGravityForce gravity({0, -10, 0});
    world.addForce(sheet, &springs);
    world.addForce(sheet, &gravity);
    for (int i = 0; i < 120; ++i) {
        world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
    }
    say("height", sheet->m_nodes[40].m_x.y());
    say("sheet is above the ground", sheet->m_nodes[40].m_x.y() > btScalar(-0.5) ? 1 : 0);
    world.removeForce(sheet, &springs);
    world.removeForce(sheet, &gravity);
    world.removeSoftBody(sheet);
    delete sheet;
    world.removeRigidBody(ground);
}

COMPARED_PROGRAM(multibody) {
    Scene<btDbvtBroadphase, btMultiBodyDynamicsWorld, btDefaultCollisionConfiguration,
          btMultiBodyConstraintSolver>
        scene;
    btMultiBodyDynamicsWorld& world = scene.world;
    scene.add(scene.things.box(0.5, 5, 5), 0, {-3, 0, 0});
    constexpr int kLinks = 5;
    auto* chain = new btMultiBody(kLinks, 1, {1, 1, 1}, true, false);
    for (int i = 0; i < kLinks; ++i) {
        chain->setupRevolute(i, 1, {1, 1, 1}, i - 1, btQuaternion::getIdentity(), {0, 0, 1},
                             {btScalar(i == 0 ? 0 : 0.5), 0, 0}, {btScalar(0.5), 0, 0}, true);
    }
    chain->finalizeMultiDof();
    chain->setBasePos({0, 3, 0});
    world.addMultiBody(chain);
    auto* box = scene.things.box(0.4, 0.2, 0.2);
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
    for (int i = 0; i < kLinks; ++i) {
        colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(chain, i));
        colliders.back()->setCollisionShape(box);
        world.addCollisionObject(colliders.back().get(), btBroadphaseProxy::DefaultFilter,
                                 btBroadphaseProxy::StaticFilter);
        chain->getLink(i).m_collider = colliders.back().get();
    }
    scene.step(180);
    say("chain has swung", chain->getJointPos(0) < -btScalar(0.3) ? 1 : 0);
    for (const auto& collider : colliders) {
        world.removeCollisionObject(collider.get());
    }
    world.removeMultiBody(chain);
    delete chain;
}

}  // namespace
}  // namespace programs
