// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/tuning.md.

#include <tests/readme/surroundings.hpp>

#include <random>

namespace hashphase::test {
namespace {

TEST(TuningPage, CostIsPrinted) {
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 100; ++i) {
        proxies.push_back(
            broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, i < 3 ? 1 : 2, 1, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    for (btBroadphaseProxy* proxy : proxies) {
        broadphase.setAabb(proxy, {0, 0, 1}, {1, 1, 2}, nullptr);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    testing::internal::CaptureStdout();
    {
#include <tuning_1.inl>
    } EXPECT_EQ(testing::internal::GetCapturedStdout(),
                "100 changed, 0 at rest, 294 boxes tested, 3 pairs watched, 100 share a cell\n");
}

struct LineCounter : btIDebugDraw {
    int lines = 0;

    void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++lines; }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                          const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    int getDebugMode() const override { return DBG_NoDebug; }
};

TEST(TuningPage, CellsAreDrawn) {
    LineCounter drawer;
    FallingSphere sphere;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world(&sphere.dispatcher, &broadphase, &sphere.solver,
                                  &sphere.configuration);
    world.setDebugDrawer(&drawer);
    world.addRigidBody(&sphere.body);
#include <tuning_2.inl>
    EXPECT_EQ(drawer.lines, 12) << "of the sphere's box";
    world.removeRigidBody(&sphere.body);
}

/// How many boxes are compared for each of 3,000 cubes of a metre, four of which overlap each.
double testsOfEach(double cellSize) {
    SpatialHashConfig config;
    config.grid.cellSize = cellSize;
    SpatialHashBroadphase broadphase(config);
    std::mt19937 random(1);
    std::uniform_real_distribution<btScalar> anywhere(0, btScalar(14.4));
    for (int i = 0; i < 3000; ++i) {
        const btVector3 min(anywhere(random), anywhere(random), anywhere(random));
        broadphase.createProxy(min, min + btVector3(1, 1, 1), 0, nullptr, 1, -1, nullptr);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    const PairCost& cost = broadphase.lastCost();
    return static_cast<double>(cost.boxesTested) / cost.grid.changed;
}

TEST(TuningPage, CostTellsOfCellsThatAreTooLarge) {
    EXPECT_LT(testsOfEach(0), 30);
    EXPECT_GT(testsOfEach(100), 100);
}

TEST(TuningPage, SettingsAreTaken) {
    {
#include <tuning_3.inl>
        EXPECT_EQ(SpatialHashBroadphase(config).grid().cellSize(), 4);
    }
    {
#include <tuning_4.inl>
        for (const SpatialHashConfig& each : {config, SpatialHashConfig()}) {
            FallingSphere sphere;
            btGhostObject ghosts[2];
            btGhostPairCallback callback;
            SpatialHashBroadphase broadphase(each);
            broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
            for (btGhostObject& ghost : ghosts) {
                ghost.setBroadphaseHandle(broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, &ghost, 1,
                                                                 -1, &sphere.dispatcher));
            }
            EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(),
                      each.eagerGhosts ? 1 : 0);
            for (btGhostObject& ghost : ghosts) {
                broadphase.destroyProxy(ghost.getBroadphaseHandle(), &sphere.dispatcher);
            }
        }
    }
#include <tuning_5.inl>
    SpatialHashBroadphase(config).calculateOverlappingPairs(nullptr);
    EXPECT_TRUE(config.parallelFor != nullptr);
}

}  // namespace
}  // namespace hashphase::test
