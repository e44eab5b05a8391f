// SPDX-License-Identifier: Zlib
//
// As flag_traps.cpp, with Bullet: worlds of the program's own, which may have been compiled without RTTI and
// without exceptions.

#include <integration/bullet/origin_shift.hpp>
#include <integration/bullet/parallel_aabbs.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_effects.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstdio>

using namespace hashphase;

namespace {

struct OwnWorld : ParallelAabbs<btDiscreteDynamicsWorld> {
    using ParallelAabbs::ParallelAabbs;
};
struct OwnDbvt : btDbvtBroadphase {};

SpatialHashConfig onThreads() {
    SpatialHashConfig config;
    config.parallelFor = serialFor;
    return config;
}

struct Scene {
    explicit Scene(btBroadphaseInterface& broadphase)
        : world(&dispatcher, &broadphase, &solver, &configuration) {
        for (int i = 0; i < 8; ++i) {
            const btTransform at(btQuaternion::getIdentity(),
                                 btVector3(btScalar(0.75) * static_cast<btScalar>(i), 0, 0));
            world.addRigidBody(new btRigidBody(1, new btDefaultMotionState(at), &box));
        }
        world.setGravity({0, 0, 0});
    }
    btBoxShape box{btVector3(1, 1, 1) / 2};
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    OwnWorld world;
};

void show(const char* name, Scene& scene) {
    std::printf("%s: %d pairs, %.1f\n", name, scene.world.getPairCache()->getNumOverlappingPairs(),
                static_cast<double>(
                    scene.world.getCollisionObjectArray()[0]->getWorldTransform().getOrigin().x()));
}

void configure(Scene& scene) {
    WorldConfigurator configurator(scene.world);
    WorldEffects effects;
    effects.pairs = false;
    configurator.apply(effects);
    show("without pairs", scene);
    configurator.apply({});
    show("with pairs", scene);
}

}  // namespace

int main() {
    SpatialHashBroadphase own(onThreads());
    Scene ours(own);
    ours.world.updateAabbs();
    ours.world.computeOverlappingPairs();
    show("our broadphase", ours);
    configure(ours);
    btRigidBody& body = *btRigidBody::upcast(ours.world.getCollisionObjectArray()[0]);
    btPoint2PointConstraint joint(body, {0, 0, 0});
    ours.world.addConstraint(&joint);
    const bool isShifted = shiftWorldOrigin(ours.world, own, {1024, 0, 0});
    std::printf("%d, joint at %.1f\n", isShifted ? 1 : 0,
                static_cast<double>(joint.getPivotInB().x()));
    show("shifted", ours);

    // What it is may be unknown: then it stays where it is, or its joints go with it.
    setAssertHandler([](const char*, const char*, const char*, int) {});
    btCollisionWorld& any = ours.world;
    const bool isBack = shiftWorldOrigin(any, own, {-1024, 0, 0});
    const btScalar jointAt = joint.getPivotInB().x();
    std::printf("%s\n", jointAt == (isBack ? 0 : -1024) ? "consistent" : "torn");
    ours.world.removeConstraint(&joint);

    OwnDbvt dbvt;
    Scene other(dbvt);
    other.world.updateAabbs();
    other.world.computeOverlappingPairs();
    show("other broadphase", other);
    configure(other);
}
