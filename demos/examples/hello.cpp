// SPDX-License-Identifier: Zlib
//
// A Bullet world over hashphase: 216 bricks that fall into a pile. You should see all of them at rest in
// the end, and Bullet's pairs compared with a look at every two boxes in each tenth step: none is
// missing, and none too many. With btDbvtBroadphase in the marked line, thousands are too many: those
// of boxes that only come near each other, or parted long ago.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <memory>
#include <vector>

namespace {

struct PairCheck {
    int missing = 0, extra = 0;

    // Adds up what is wrong with the world's pairs now.
    void add(btCollisionWorld& world) {
        btOverlappingPairCache& pairs = *world.getPairCache();
        const btCollisionObjectArray& objects = world.getCollisionObjectArray();
        extra += pairs.getNumOverlappingPairs();
        for (int i = 0; i < objects.size(); ++i) {
            btBroadphaseProxy* a = objects[i]->getBroadphaseHandle();
            for (int k = 0; k < i; ++k) {
                btBroadphaseProxy* b = objects[k]->getBroadphaseHandle();
                if (pairs.needsBroadphaseCollision(a, b) &&
                    TestAabbAgainstAabb2(a->m_aabbMin, a->m_aabbMax, b->m_aabbMin, b->m_aabbMax)) {
                    (pairs.findPair(a, b) == nullptr ? ++missing : --extra);
                }
            }
        }
    }
};

}  // namespace

int main() {
    btStaticPlaneShape plane({0, 1, 0}, 0);
    btBoxShape brick({0.4F, 0.2F, 0.2F});
    std::vector<std::unique_ptr<btRigidBody>> bodies;  // declared first: they outlive the world
    const auto add = [&bodies](btDynamicsWorld& world, btScalar mass, btCollisionShape& shape,
                               const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        shape.calculateLocalInertia(mass, inertia);
        bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
        bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
        world.addRigidBody(bodies.back().get());
    };

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    hashphase::SpatialHashBroadphase broadphase;  // was: btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    add(world, 0, plane, {0, 0, 0});
    for (int i = 0; i < 216; ++i) {
        const int layer = i / 36;
        const btVector3 place(btScalar(i % 6), btScalar(layer + 1), btScalar(i / 6 % 6));
        add(world, 1, brick, place + btVector3(0.3F, 0, 0.2F) * btScalar(layer % 3));
    }

    PairCheck check;
    for (int step = 0; step < 900; ++step) {
        world.stepSimulation(1.0F / 60, 0);
        if (step % 10 == 0) {
            check.add(world);
        }
    }
    int resting = 0;
    for (const auto& body : bodies) {
        resting += body->isActive() ? 0 : 1;  // the ground, too
    }
    std::printf("at rest after 900 steps: %d of 217 bodies, with %d pairs\n", resting,
                world.getPairCache()->getNumOverlappingPairs());
    std::printf("pairs missing: %d, extra: %d\n", check.missing, check.extra);
}
