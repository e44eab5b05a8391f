// SPDX-License-Identifier: Zlib

// Callbacks of a world that remove bodies from it.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

/// Boxes that fall on a floor, over our broadphase.
struct FallingBoxes {
    explicit FallingBoxes(int count) {
        addBox(0, {0, -10, 0}, {50, 10, 50});
        for (int i = 0; i < count; ++i) {
            const auto x = btScalar(i % 5);
            addBox(1, {x * btScalar(0.9), btScalar(1 + i / 5), 0}, {0.5, 0.5, 0.5});
        }
        current = this;
    }
    ~FallingBoxes() {
        while (world.getNumCollisionObjects() > 0) {
            removeLast();
        }
    }
    FallingBoxes(const FallingBoxes&) = delete;
    FallingBoxes& operator=(const FallingBoxes&) = delete;

    void addBox(btScalar mass, const btVector3& at, const btVector3& half) {
        shapes.push_back(std::make_unique<btBoxShape>(half));
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes.back().get());
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
    }
    void remove(btCollisionObject* object) { world.removeRigidBody(btRigidBody::upcast(object)); }
    void removeLast() {
        remove(world.getCollisionObjectArray()[world.getNumCollisionObjects() - 1]);
    }
    void step() { world.stepSimulation(btScalar(1) / 60, 0); }

    static inline FallingBoxes* current = nullptr;  // of callbacks without a pointer of the user's

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    SpatialHashBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

TEST(WorldCallbacks, OfTicksMayRemoveBodies) {
    for (const bool isBefore : {false, true}) {
        FallingBoxes boxes(30);
        boxes.world.setInternalTickCallback(
            [](btDynamicsWorld*, btScalar) { FallingBoxes::current->removeLast(); }, nullptr,
            isBefore);
        for (int step = 0; step < 20; ++step) {
            boxes.step();
            EXPECT_EQ(boxes.broadphase.grid().validate(), "");
        }
        EXPECT_EQ(boxes.world.getNumCollisionObjects(), 31 - 20);
        boxes.world.setInternalTickCallback(nullptr, nullptr, isBefore);
        boxes.step();
        EXPECT_EQ(boxes.broadphase.validate(), "");
    }
}

TEST(WorldCallbacks, OfTheDispatcherMayRemoveBodiesWhenItIsDoneWithThem) {
    static int calls = 0;
    calls = 0;
    FallingBoxes boxes(40);
    boxes.dispatcher.setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                                        const btDispatcherInfo& info) {
        auto* const first = static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
        auto* const second = static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
        btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
        if (++calls % 9 == 0) {
            FallingBoxes::current->remove(first->isStaticObject() ? second : first);
        }
    });
    for (int step = 0; step < 20; ++step) {
        boxes.step();
        EXPECT_EQ(boxes.broadphase.grid().validate(), "");
    }
    EXPECT_GT(calls, 100);
    EXPECT_LT(boxes.world.getNumCollisionObjects(), 35);
}

TEST(WorldCallbacks, OfAWorldsRayTestMayRemoveBodies) {
    struct Removing : btCollisionWorld::RayResultCallback {
        btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
            auto* const hit = const_cast<btCollisionObject*>(result.m_collisionObject);
            EXPECT_TRUE(removed.insert(hit).second) << "who was removed is hit";
            FallingBoxes::current->remove(hit);
            return 1;
        }
        std::set<btCollisionObject*> removed;
    };
    for (const bool isClosest : {false, true}) {
        FallingBoxes boxes(40);
        boxes.step();
        Removing removing;
        const btVector3 from(btScalar(0.1), 20, btScalar(0.1));
        const btVector3 to(btScalar(0.1), btScalar(0.6), btScalar(0.1));
        if (isClosest) {
            boxes.broadphase.closestRay(from, to, removing);
        } else {
            boxes.world.rayTest(from, to, removing);
        }
        EXPECT_GT(removing.removed.size(), 4U);
        for (int step = 0; step < 3; ++step) {
            boxes.step();
            EXPECT_EQ(boxes.broadphase.validate(), "");
        }
    }
}

}  // namespace
}  // namespace hashphase::test
